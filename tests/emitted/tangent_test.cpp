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

// With t in every summand, and a matrix that is without it.
constexpr const char* kDriven =
    "system driven\nsize N = 5\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\n"
    "momentum p[1..N]\ntime t\nparameter m[1..N] = 2\n"
    "H = sum(i = 1..N, p[i]^2/(2*m[i])) + sum(i = 0..N, (1 + cos(t)/2)*(q[i+1] - q[i])^2/2)"
    " + sum(i = 1..N, q[i]^4/4 - i*sin(3*t)*q[i])";

constexpr const char* kDifference = R"(
#include <cmath>
#include <cstdio>
#include <initializer_list>
int main() {
  loops::State a;
  written::State b;
  for (int i = 0; i < 5; ++i) {
    a.q[i] = b.q[i] = 0.3 * i - 0.5;
    a.p[i] = b.p[i] = 0.2 - 0.1 * i;
  }
  a.q[5] = b.t = 0.7;
  double largest = 0;
  for (const double h : {0.01, 0.1, 0.4}) {
    double m[12][12], n[12][12];
    if (!loops::tangent({}, h, a, {}, m) || !written::tangent({}, h, b, {}, n)) return 1;
    for (int i = 0; i < 12; ++i) {
      for (int j = 0; j < 12; ++j) {
        const double error = std::fabs(m[i][j] - n[i][j]);
        if (!(error <= largest)) largest = error;
      }
    }
  }
  std::printf("%.17g", largest);
}
)";

TEST(EmittedTangent, OfASystemWithTimeIsTheSameInLoops) {
  for (const std::string more : {"", " + sum(i = 1..N, cos(t)*p[i]*q[i]/5)"}) {
    for (Request request : {Request{}, Request{.alpha = "1/3", .beta = "h/5"},
                            Request{.alpha = "1/3", .gamma = "-h/7"}}) {
      request.tangent = true;
      std::string text;
      for (const bool in_loops : {true, false}) {
        request.in_loops = in_loops;
        request.name_space = in_loops ? "loops" : "written";
        text +=
            without_pragma(emit(make_source("driven.ham", kDriven + more + "\n"), request)[0].text);
      }
      const std::string output = run_program(text + kDifference, {"-ffp-contract=off"});
      ASSERT_NE(output, "") << more;
      // Two eliminations of a dozen rows; what t moves is 1e-4 to 1e-1.
      EXPECT_LT(std::stod(output), 1e-14) << more;
    }
  }
}

}  // namespace
}  // namespace hamgen::emitted_test
