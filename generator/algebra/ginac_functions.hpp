// The functions of the table as GiNaC objects.
#pragma once

#include <ginac/ginac.h>

#include <string_view>

#include "generator/algebra/functions.hpp"

namespace hamgen {

// By which GiNaC knows a function of the table, which the table names as GiNaC does.  One that is
// new to GiNaC is told to it, with the value and the derivatives that its row has.
[[nodiscard]] unsigned ginac_serial(const Function& function);

// The arguments must be as many as the table says.  Throws std::domain_error on a value that GiNaC
// finds undefined (log(0)), and where the result would not be real.
[[nodiscard]] GiNaC::ex ginac_function(std::string_view name, const GiNaC::exvector& arguments);

}  // namespace hamgen
