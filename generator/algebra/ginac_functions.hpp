// The functions of the table as GiNaC objects.
#pragma once

#include <ginac/ginac.h>

#include <string_view>

namespace hamgen {

// The arguments must be as many as the table says.  Throws std::domain_error on a value that GiNaC
// finds undefined (log(0)), and where the result would not be real.
[[nodiscard]] GiNaC::ex ginac_function(std::string_view name, const GiNaC::exvector& arguments);

}  // namespace hamgen
