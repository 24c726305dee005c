// Numbers in the digits of their scalar.
#pragma once

#include <string>

#include "runtime/wide.hpp"

namespace hamgen::app {

// Of a scalar of so many binary digits: up to a double's the fewest that read back to the same
// double; 20 for long double, and for quad the 32 that hi + lo holds.  Empty if it is not finite.
[[nodiscard]] std::string wide_text(const runtime::Wide& value, int binary_digits);

}  // namespace hamgen::app
