// The tangent map that a header computes, beside that of the same step in quad numbers.
#include <gtest/gtest.h>

#include "generator/base/source_text.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

// A charge that turns fast in a field along its way: its square root is far from quadratic, so that
// an iterate before the last one is seen.
constexpr const char* kSolenoid =
    "system solenoid\ncoordinate x, y, s\nmomentum u, v, w\nparameter b = 0.7\nparameter c = 3\n"
    "let a = b/2*(1 + s/10)\n"
    "H = c*sqrt(c^2 + (u + a*y)^2 + (v - a*x)^2 + w^2) - x^2*y/5 + x*y^3/20\n";

constexpr const char* kLargestError = R"(
#include <cmath>
#include <cstdio>
int main() {
  const double z[6] = {0.4, -0.2, 0.1, 0.3, 0.5, 0.8};
  rounded::State a{z[0], z[1], z[2], z[3], z[4], z[5]};
  exact::State b{z[0], z[1], z[2], z[3], z[4], z[5]};
  double largest = 0;
  for (int k = 1; k <= 24; ++k) {
    const double h = k / 64.0;
    double m[6][6];
    __float128 n[6][6];
    if (!rounded::tangent({}, h, a, {}, m) || !exact::tangent({}, h, b, {}, n)) return 1;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        const double error = std::fabs(double(m[i][j] - n[i][j]));
        if (!(error <= largest)) largest = error;
      }
    }
  }
  std::printf("%.17g", largest);
}
)";

double largest_error(const std::string& scheme) {
  std::string text;
  for (const auto& [scalar, name] : {std::pair("double", "rounded"), std::pair("quad", "exact")}) {
    const Request request{.scheme = scheme, .scalar = scalar, .name_space = name, .tangent = true};
    text += without_pragma(emit(make_source("solenoid.ham", kSolenoid), request).front().text);
  }
  const std::string output = run_program(text + kLargestError, {"-ffp-contract=off"});
  EXPECT_NE(output, "") << scheme;
  return output.empty() ? 1.0 : std::stod(output);
}

// Of substeps, too, it is taken where the step ends, not where its iteration did.
TEST(EmittedTangent, IsThatOfTheSolvedStepToRounding) {
  for (const char* scheme : {"implicit-midpoint", "gauss-4", "yoshida-4", "suzuki-4"})
    EXPECT_LT(largest_error(scheme), 5e-15) << scheme;
}

}  // namespace
}  // namespace hamgen::emitted_test
