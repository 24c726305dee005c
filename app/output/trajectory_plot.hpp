// Pictures of a trajectory: the orbit, its momenta, its energy error, or the columns that are
// named.
#pragma once

#include <string>
#include <vector>

#include "app/output/number_table.hpp"
#include "app/output/plot.hpp"

namespace hamgen::app {

// A panel each of `columns`: "a" over time, "a:b" b over a, "a:b:c" seen along the diagonal of
// three axes; energy_error is H minus its first value, of the energy's scale if the table has it.
// Without any: what the table's columns
// offer, of one degree of freedom p over q, of two and three the orbit and its projections, of more
// the coordinates over time, then momenta and energy error.  Throws UsageError for a name it does
// not have.
[[nodiscard]] Plot trajectory_plot(const NumberTable& table, const std::string& columns,
                                   const std::string& title);

// Throws UsageError unless a table with these columns can be drawn so.
void require_columns(const std::vector<std::string>& names, const std::string& columns);

// Throws UsageError unless a picture can have this name.
void require_picture_name(const std::string& option, const std::string& path);

}  // namespace hamgen::app
