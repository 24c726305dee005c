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

struct Between {
  State state;      // at kTime, by a part of the step
  double cubic_q;   // by the cubic through both ends of the step and their derivatives
  double square_q;  // by the parabola through both ends and the derivative at the first
};

Between between(const std::string& scheme, const std::string& h_text) {
  const auto orbit = interpreted_orbit(kSwing, scheme, h_text, "quad");
  const double h = orbit->start.h.hi;
  const auto steps = static_cast<long>(std::floor(kTime / h));
  runtime::Integrator integrator(orbit->library, orbit->start);
  EXPECT_EQ(integrator.advance(steps, false).status, runtime::Status::done) << scheme;
  const State before = integrator.state();
  EXPECT_EQ(integrator.advance(1, false).status, runtime::Status::done) << scheme;
  const State after = integrator.state();
  const double s = kTime / h - static_cast<double>(steps);
  const auto state = runtime::part_of_step(orbit->library, orbit->start, before, {s, 0.0});
  EXPECT_TRUE(state) << scheme;
  const double r = 1 - s;
  const double square =
      before[0].hi + s * h * before[1].hi + s * s * (after[0].hi - before[0].hi - h * before[1].hi);
  const double cubic = (1 + 2 * s) * r * r * before[0].hi + s * r * r * h * before[1].hi +
                       s * s * (1 + 2 * r) * after[0].hi - s * s * r * h * after[1].hi;
  return {state.value_or(before), cubic, square};
}

// To 1e-31: 16th order at a step of 1/32.
const Between& exact() {
  static const Between result = between("gauss-16", "1/32");
  return result;
}

double error(const Between& found) {
  return std::hypot(runtime::difference(found.state[0], exact().state[0]),
                    runtime::difference(found.state[1], exact().state[1]));
}

class DenseOutput : public testing::TestWithParam<std::string> {};

TEST_P(DenseOutput, HasTheOrderOfItsScheme) {
  const Scheme* scheme = find_scheme(GetParam());
  ASSERT_NE(scheme, nullptr);
  // Small where the order is low, and its constants are seen late; not so small that the last
  // digits of quad are.
  const auto [coarse_h, fine_h] = scheme->order <= 3   ? std::pair{"1/32", "1/64"}
                                  : scheme->order <= 6 ? std::pair{"1/8", "1/16"}
                                  : scheme->order <= 8 ? std::pair{"1/4", "1/8"}
                                                       : std::pair{"1/2", "1/4"};
  const Between coarse = between(GetParam(), coarse_h);
  const Between fine = between(GetParam(), fine_h);
  const double measured = std::log2(error(coarse) / error(fine));
  EXPECT_NEAR(measured, scheme->order, scheme->order > 8 ? 1.0 : 0.5)
      << error(coarse) << " " << error(fine);
}

std::vector<std::string> scheme_names() {
  std::vector<std::string> names;
  for (const Scheme& scheme : all_schemes()) names.push_back(scheme.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Schemes, DenseOutput, testing::ValuesIn(scheme_names()),
                         [](const auto& scheme) {
                           std::string name = scheme.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

// The negative control: of Gauss-4 a parabola has order 3 where the parts of steps have 4, of
// Gauss-8 a cubic 4 where they have 8.
TEST(DenseOutputControl, PolynomialsHaveTheirOwnOrder) {
  const auto order = [](const std::string& scheme, auto value) {
    const double exact_q = exact().state[0].hi;
    return std::log2(std::abs(value(between(scheme, "1/4")) - exact_q) /
                     std::abs(value(between(scheme, "1/8")) - exact_q));
  };
  const double square = order("gauss-4", [](const Between& b) { return b.square_q; });
  const double cubic = order("gauss-8", [](const Between& b) { return b.cubic_q; });
  EXPECT_LT(square, 3.5);
  EXPECT_LT(cubic, 5.0);
}

}  // namespace
}  // namespace hamgen::app_test
