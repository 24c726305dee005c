// The implicit equations are solved to round-off at every step, whatever the start value.
#include <gtest/gtest.h>

#include "tests/numerics/dense_step.hpp"
#include "tests/numerics/emitted_run.hpp"

namespace hamgen::numerics_test {
namespace {

using J = Jet<long double>;

J pendulum_energy(const std::vector<J>& z) { return 0.5L * (z[1] * z[1]) - cos(z[0]); }
const std::string pendulum = "coordinate q\nmomentum p\nH = p^2/2 - cos(q)\n";

// The largest difference of one step of the run from the step by hand from the same state.
long double worst_step(const Emitted& emitted, long double h, int steps) {
  runtime::Integrator run = emitted.start({1.5L, 0.0L}, h);
  const Parameters3<long double> midpoint{{0.5L}, {0}, {0}};
  long double worst = 0;
  for (int i = 0; i < steps; ++i) {
    const Vector before = state(run);
    if (run.advance(1, false).status != runtime::Status::done) return HUGE_VALL;
    worst = std::max(
        worst, distance(state(run), dense_step<long double>(pendulum_energy, midpoint, h, before)));
  }
  return worst;
}

class Convergence : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Solvers, Convergence, ::testing::Values("newton", "fixed-point"),
                         [](const auto& instance) {
                           return instance.index == 0 ? "newton" : "fixed_point";
                         });

TEST_P(Convergence, IsToRoundOffAtEveryStep) {
  const Emitted emitted(pendulum, {.solver = GetParam()});
  for (const long double h : {0.0625L, 0.125L, 0.25L, 0.5L, 1.0L}) {
    // Values up to pi have units in the last place of 4.4e-16; a step may round a few times.
    EXPECT_LT(worst_step(emitted, h, 2000), 3e-15L) << "h = " << static_cast<double>(h);
  }
}

TEST_P(Convergence, IsToRoundOffInLongDouble) {
  const Emitted emitted(pendulum, {.solver = GetParam(), .scalar = "long-double"});
  for (const long double h : {0.0625L, 0.5L}) {
    EXPECT_LT(worst_step(emitted, h, 2000), 3e-18L) << "h = " << static_cast<double>(h);
  }
}

}  // namespace
}  // namespace hamgen::numerics_test
