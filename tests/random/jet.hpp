// A value with its gradient in quad, by the rules that define derivatives and nothing of hamgen's.
#pragma once

#include <string>
#include <vector>

namespace hamgen::random {

__extension__ typedef __float128 Quad;
using Vector = std::vector<Quad>;

struct Jet {
  Quad value = 0;
  Vector gradient = {};  // empty: 0
};

[[nodiscard]] Jet operator+(const Jet& x, const Jet& y);
[[nodiscard]] Jet operator-(const Jet& x, const Jet& y);
[[nodiscard]] Jet operator*(const Jet& x, const Jet& y);
[[nodiscard]] Jet operator/(const Jet& x, const Jet& y);
[[nodiscard]] Jet power(const Jet& base, const Jet& exponent);
// A function of the language; std::out_of_range for a name that is none.
[[nodiscard]] Jet apply_function(const std::string& function, const std::vector<Jet>& arguments);

}  // namespace hamgen::random
