#include "app/output/wide_text.hpp"

#include <quadmath.h>

#include <array>
#include <cmath>

#include "runtime/csv_writer.hpp"

namespace hamgen::app {

std::string wide_text(const runtime::Wide& value, int binary_digits) {
  if (binary_digits <= 53 || !std::isfinite(value.hi)) return runtime::number_text(value.hi);
  const int digits = binary_digits <= 64 ? 20 : 32;
  std::array<char, 64> text{};
  const __float128 sum = static_cast<__float128>(value.hi) + value.lo;
  quadmath_snprintf(text.data(), text.size(), "%.*Qg", digits, sum);
  return text.data();
}

}  // namespace hamgen::app
