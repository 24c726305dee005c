// What `hamgen bench` says: a table to read, CSV and JSON of the same rows.
#pragma once

#include <string>

#include "app/studies/bench.hpp"

namespace hamgen::app {

// Why there are no state errors, as a line for the screen; empty if there are.
[[nodiscard]] std::string warning_text(const Bench& bench);
// The answers, and the rows; of these the answers and the Pareto front, or all.
[[nodiscard]] std::string table_text(const Bench& bench, bool all_rows);
[[nodiscard]] std::string csv_text(const Bench& bench);
[[nodiscard]] std::string json_text(const Bench& bench);

}  // namespace hamgen::app
