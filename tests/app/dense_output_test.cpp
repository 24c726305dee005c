// States between steps: of the order of the step, for every scheme.
#include <gtest/gtest.h>

#include <cmath>

#include "generator/schemes/all_schemes.hpp"
#include "runtime/event.hpp"
#include "tests/app/interpreted_orbit.hpp"

namespace hamgen::app_test {
namespace {

using State = std::vector<runtime::Wide>;

// Separable, its kinetic energy quadratic, not linear.
constexpr const char* kSwing =
    "system swing\ncoordinate q\nmomentum p\nH = p^2/2 - cos(q)\nscene wide { q = 1 }\n";
// At the end of no step below, and a part of each that a double holds exactly.
constexpr double kTime = 933.0 / 256.0;

// "implicit-midpoint:6" is the member raised to order 6.
State between(const std::string& method, const std::string& h_text) {
  const std::size_t colon = method.find(':');
  const std::string scheme = method.substr(0, colon);
  const int raised = colon == std::string::npos ? 0 : std::stoi(method.substr(colon + 1));
  const auto orbit = interpreted_orbit(kSwing, scheme, h_text, "quad", raised);
  const double h = orbit->start.h.hi;
  const auto steps = static_cast<long>(std::floor(kTime / h));
  runtime::Integrator integrator(orbit->library, orbit->start);
  EXPECT_EQ(integrator.advance(steps, false).status, runtime::Status::done) << scheme;
  const State before = integrator.state();
  const double s = kTime / h - static_cast<double>(steps);
  const auto state = runtime::part_of_step(orbit->library, orbit->start, before, {s, 0.0});
  EXPECT_TRUE(state) << scheme;
  return state.value_or(before);
}

// To 1e-31: Gauss of order 16 at a step of 1/32, as DenseOutputControl computes it.
const State kExact = {{-0x1.ed6293c80a521p-1, -0x1.6868a9c360144p-55},
                      {0x1.f792be00c6e03p-3, 0x1.63d0a0b68bd61p-59}};

double error(const State& found) {
  return std::hypot(runtime::difference(found[0], kExact[0]),
                    runtime::difference(found[1], kExact[1]));
}

class DenseOutput : public testing::TestWithParam<std::string> {};

TEST_P(DenseOutput, HasTheOrderOfItsScheme) {
  const std::size_t colon = GetParam().find(':');
  const Scheme* scheme = find_scheme(GetParam().substr(0, colon));
  ASSERT_NE(scheme, nullptr);
  const int order =
      colon == std::string::npos ? scheme->order : std::stoi(GetParam().substr(colon + 1));
  // Small where the order is low, and its constants are seen late; not so small that the last
  // digits of quad are.
  const auto [coarse_h, fine_h] = order <= 3   ? std::pair{"1/32", "1/64"}
                                  : order <= 6 ? std::pair{"1/8", "1/16"}
                                  : order <= 8 ? std::pair{"1/4", "1/8"}
                                               : std::pair{"1/2", "1/4"};
  const State coarse = between(GetParam(), coarse_h);
  const State fine = between(GetParam(), fine_h);
  const double measured = std::log2(error(coarse) / error(fine));
  EXPECT_NEAR(measured, order, order > 8 ? 1.0 : 0.5) << error(coarse) << " " << error(fine);
}

std::vector<std::string> scheme_names() {
  std::vector<std::string> names;
  for (const Scheme& scheme : all_schemes()) names.push_back(scheme.name);
  for (const char* raised : {"4", "6", "8"})
    names.push_back(std::string("implicit-midpoint:") + raised);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Schemes, DenseOutput, testing::ValuesIn(scheme_names()),
                         [](const auto& scheme) {
                           std::string name = scheme.param;
                           for (char& c : name) c = c == '-' || c == ':' ? '_' : c;
                           return name;
                         });

// How far polynomials through the ends of a step are from its part, in q, half way from t = 1.
struct Defects {
  double parabola = 0.0;  // both ends and the derivative at the first
  double cubic = 0.0;     // both ends and their derivatives
};

Defects defects(const std::string& scheme, const std::string& h_text) {
  const auto orbit = interpreted_orbit(kSwing, scheme, h_text, "quad");
  const double h = orbit->start.h.hi;
  runtime::Integrator integrator(orbit->library, orbit->start);
  (void)integrator.advance(std::lround(1.0 / h), false);
  const State a = integrator.state();
  (void)integrator.advance(1, false);
  const State b = integrator.state();
  const auto part = runtime::part_of_step(orbit->library, orbit->start, a, {0.5, 0.0});
  EXPECT_TRUE(part);
  const double q = part.value_or(a)[0].hi;
  const double parabola = a[0].hi + h * a[1].hi / 2 + (b[0].hi - a[0].hi - h * a[1].hi) / 4;
  const double cubic = (a[0].hi + b[0].hi) / 2 + h * (a[1].hi - b[1].hi) / 8;
  return {std::abs(parabola - q), std::abs(cubic - q)};
}

TEST(DenseOutputControl, TheExactStateIsThatOfManyStepsOfHighOrder) {
  EXPECT_LT(error(between("gauss-16", "1/32")), 1e-31);
  EXPECT_GT(error(between("gauss-8", "1/32")), 1e-30);
}

// The negative control: a parabola has order 3 where the parts of a Gauss-4 step have 5 within it,
// a cubic 4 where those of Gauss-8 have 9.
TEST(DenseOutputControl, PolynomialsHaveTheirOwnOrder) {
  const double parabola =
      std::log2(defects("gauss-4", "1/8").parabola / defects("gauss-4", "1/16").parabola);
  EXPECT_NEAR(parabola, 3, 0.3);
  const double cubic =
      std::log2(defects("gauss-8", "1/8").cubic / defects("gauss-8", "1/16").cubic);
  EXPECT_NEAR(cubic, 4, 0.3);
}

}  // namespace
}  // namespace hamgen::app_test
