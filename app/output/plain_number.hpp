// Numbers as people write them: "0.0125", "1060", "9.6 times ten to the power of -5".
#pragma once

#include <optional>
#include <string>

namespace hamgen::app {

// A power of ten in Unicode: "10⁻⁶".
[[nodiscard]] std::string power_of_ten(int exponent);

// So many significant digits: "-9.6" and -5, or "0.0125" without a power of ten.
struct DecimalParts {
  std::string mantissa;
  std::optional<int> exponent;
};
[[nodiscard]] DecimalParts decimal_parts(double value, int digits);

// So many significant digits, without a power of ten from 1e-3 to 1e5; "–" for what is not finite.
// In plain text the power is 10⁻⁵, in HTML it has <sup>.
[[nodiscard]] std::string plain_number(double value, int digits);
[[nodiscard]] std::string html_number(double value, int digits);

// For a terminal: so many digits and all those before the point, "3450", "73.4", "0.0123".
[[nodiscard]] std::string terminal_number(double value, int digits);

}  // namespace hamgen::app
