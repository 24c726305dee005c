// Emitted integrators of higher order by the generating function.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/numerics/emitted_run.hpp"

namespace hamgen::numerics_test {
namespace {

double worst_energy(const Emitted& emitted, const Vector& start, long double h, long long steps) {
  runtime::Integrator run = emitted.start(start, h);
  const runtime::Wide first = run.energy();
  const runtime::Report report = run.advance(steps, true);
  EXPECT_EQ(report.status, runtime::Status::done);
  if (!report.energy) return HUGE_VAL;
  return std::max(difference(report.energy->max, first), difference(first, report.energy->min));
}

struct Figure {
  int order;
  double most;  // max |dH|
};

class Pendulum : public ::testing::TestWithParam<Figure> {};
// The reference figures, to their two digits.
INSTANTIATE_TEST_SUITE_P(Orders, Pendulum,
                         ::testing::Values(Figure{4, 2.35e-7}, Figure{6, 1.05e-9},
                                           Figure{8, 8.45e-12}, Figure{10, 1.65e-14}),
                         [](const auto& i) { return "order" + std::to_string(i.param.order); });

TEST_P(Pendulum, KeepsItsEnergyAtAStepOfOne) {
  const Emitted emitted = Emitted::shipped("pendulum", {.order = GetParam().order});
  const double error = worst_energy(emitted, {3.1L, 0}, 1, 20000);
  EXPECT_LE(error, GetParam().most);
  EXPECT_GE(error, 0.9 * GetParam().most);  // it is the method's error, not luck
}

class HenonHeiles : public ::testing::TestWithParam<Figure> {};
INSTANTIATE_TEST_SUITE_P(Orders, HenonHeiles,
                         ::testing::Values(Figure{4, 2.45e-8}, Figure{6, 5.05e-11},
                                           Figure{8, 1.35e-13}),
                         [](const auto& i) { return "order" + std::to_string(i.param.order); });

TEST_P(HenonHeiles, KeepsItsEnergy) {
  const Emitted emitted = Emitted::shipped("henon_heiles", {.order = GetParam().order});
  EXPECT_LE(worst_energy(emitted, {0.1L, 0.2L, 0.3L, -0.1L}, 0.1L, 10000), GetParam().most);
}

// A gauge that depends on h, raised: the generating function takes its series in h.
TEST(RaisedOrder, OfALocallyExactGaugeIsObserved) {
  const std::string text = "coordinate q\nmomentum p\nH = p^2/2 - cos(q)\n";
  const Vector start = {2.0L, 0.0L};
  const Vector exact =
      Emitted(text, {.scheme = "gauss-16", .scalar = "long-double"}).after(128, start, 0x1p-5L);
  for (const int order : {4, 6}) {
    const Emitted member(text, {.order = order, .gauge = "locally-exact", .scalar = "long-double"});
    std::vector<long double> errors;
    for (int k = 2; k <= 4; ++k) {
      errors.push_back(distance(member.after(4 << k, start, std::ldexp(1.0L, -k)), exact));
    }
    EXPECT_NEAR(observed_orders(errors).back(), order, 0.2);
  }
}

// Newton with the Hessian of H, its linear system reduced to the positions: the step is still
// solved to round-off, as the exact conservation of angular momentum shows.
TEST(Kepler, KeepsItsAngularMomentumAtOrderEight) {
  const Emitted emitted = Emitted::shipped("kepler", {.order = 8});
  EXPECT_NE(emitted.source().solver.find("simplified Newton"), std::string::npos);
  runtime::Integrator run = emitted.start({0.4L, 0, 0, 2}, 0.05L);
  const runtime::Wide before = run.invariants()[0];
  ASSERT_EQ(run.advance(100000, false).status, runtime::Status::done);
  // Round-off grows like the root of the number of steps: 316 units of 1.1e-16.
  EXPECT_NEAR(difference(run.invariants()[0], before), 0.0, 3.5e-14);
}

}  // namespace
}  // namespace hamgen::numerics_test
