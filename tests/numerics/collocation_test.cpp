// Gauss collocation: every step is solved to round-off, from whatever start, and nothing drifts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/numerics/emitted_run.hpp"

namespace hamgen::numerics_test {
namespace {

struct Orbit {
  const char* model;
  Vector start;
  long double h;
  Vector parameters = {};         // the defaults if empty
  long double amplification = 2;  // of a perturbation of the state, by one step, at most
};

// The pendulum and the spring start at rest: the first iterations move one half of the components
// only.  The last one starts with a momentum far below the rounding of the coordinate.
const Orbit kPendulum = {.model = "pendulum", .start = {3.1L, 0}, .h = 0.2L};
const Orbit kLargeSteps = {.model = "pendulum", .start = {3.1L, 0}, .h = 2};
const Orbit kKepler = {.model = "kepler", .start = {0.4L, 0, 0, 2}, .h = 0.05L};
const Orbit kHenonHeiles = {.model = "henon_heiles", .start = {0.1L, 0.2L, 0.3L, -0.1L}, .h = 0.1L};
const Orbit kProduct = {.model = "product", .start = {0, -3}, .h = 0.02L};
// k = 1e4: the spring turns by 2 rad a step, which takes Newton for the lower orders; q and p
// differ by its frequency of 100.
const Orbit kStiffSpring = {.model = "spring_pendulum",
                            .start = {1, 0, 0, 0},
                            .h = 0.02L,
                            .parameters = {1e4L},
                            .amplification = 200};
const Orbit kTinyMomentum = {.model = "pendulum", .start = {1, 1e-12L}, .h = 0.5L};

// The method is symmetric: a step back from where a step went ends where it began, if both are
// solved.  A step that is not leaves an error of the size of its last increment.
// Rounding: each of the two steps rounds the state, and less its increments; the step back
// multiplies what the first one rounds.  In units of rounding of the largest component.
long double worst_return(const Emitted& emitted, const Orbit& orbit, int steps) {
  runtime::Integrator run = emitted.start(orbit.start, orbit.h, orbit.parameters);
  long double worst = 0;
  for (int i = 0; i < steps; ++i) {
    const Vector before = state(run);
    if (run.advance(1, false).status != runtime::Status::done) return HUGE_VALL;
    const Vector back = emitted.after(1, state(run), -orbit.h, orbit.parameters);
    const long double scale = std::max(distance(before, Vector(before.size())), 1.0L);
    worst = std::max(worst, distance(back, before) / scale);
  }
  return worst / std::numeric_limits<double>::epsilon();
}

class Gauss : public ::testing::TestWithParam<int> {
 protected:
  [[nodiscard]] std::string scheme() const { return "gauss-" + std::to_string(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Orders, Gauss, ::testing::Values(2, 4, 6, 8, 10, 12, 14, 16));

TEST_P(Gauss, SolvesEveryStepOfAPendulumToRoundOffAlsoFromRest) {
  const Emitted emitted = Emitted::shipped("pendulum", {.scheme = scheme()});
  for (const Orbit& orbit : {kPendulum, kLargeSteps, kTinyMomentum}) {
    EXPECT_LE(worst_return(emitted, orbit, 1000), 2 * orbit.amplification)
        << "h = " << static_cast<double>(orbit.h);
  }
}

class GaussOfSomeOrders : public Gauss {};
INSTANTIATE_TEST_SUITE_P(Orders, GaussOfSomeOrders, ::testing::Values(2, 4, 8, 16));

class GaussOfHighOrder : public Gauss {};
INSTANTIATE_TEST_SUITE_P(Orders, GaussOfHighOrder, ::testing::Values(10, 12, 16));

long double kepler_energy(const runtime::Integrator& run) {
  const Vector z = state(run);
  return (z[2] * z[2] + z[3] * z[3]) / 2 - 1 / std::sqrt(z[0] * z[0] + z[1] * z[1]);
}

TEST_P(GaussOfSomeOrders, SolvesEveryStepOfOtherSystemsToRoundOff) {
  for (const Orbit& orbit : {kKepler, kHenonHeiles, kProduct, kStiffSpring}) {
    const Emitted emitted = Emitted::shipped(orbit.model, {.scheme = scheme()});
    EXPECT_LE(worst_return(emitted, orbit, 1000), 2 * orbit.amplification) << orbit.model;
  }
}

// Where the method's own error is below rounding, the energy only walks at random.  In 16 times the
// steps the root mean square of a random walk grows 4 times, that of a drift 16 times; estimated
// from 32 runs each, the ratio of two is within a factor of 1.65 of its value with a probability of
// 99 per cent (F distribution), and the seeds are fixed.
// A half period a step and more: iterations go far astray, where the Hessian is so large that the
// increments look like rounding.  What is accepted there must still solve the equations: a solution
// keeps the energy to a third (0.079 of 0.25 at most), what does not was 1e177.
TEST(GaussOnAQuarticWall, AcceptsNoStepThatSolvesNothing) {
  for (const auto& [order, h] : {std::pair(8, 4.0L), {8, 2.5L}, {6, 3.0L}, {6, 3.5L}, {12, 3.5L}}) {
    const std::string scheme = "gauss-" + std::to_string(order);
    const Emitted emitted("coordinate q\nmomentum p\nH = p^2/2 + q^4/4\n", {.scheme = scheme});
    runtime::Integrator run = emitted.start({1, 0}, h);
    (void)run.advance(300, false);  // it may stop
    const Vector z = state(run);
    EXPECT_NEAR(static_cast<double>(z[1] * z[1] / 2 + z[0] * z[0] * z[0] * z[0] / 4), 0.25, 0.09)
        << scheme << ", h = " << h;
  }
}

TEST_P(GaussOfHighOrder, LetsTheEnergyOfKeplerWalkAtRandomOnly) {
  const Emitted emitted = Emitted::shipped("kepler", {.scheme = scheme()});
  constexpr int starts = 32;
  constexpr long long steps = 6250;
  double early = 0;
  double late = 0;
  for (int i = 0; i < starts; ++i) {
    const long double angle = 0.1L + i;
    const long double c = std::cos(angle);
    const long double d = std::sin(angle);
    runtime::Integrator run = emitted.start({0.4L * c, 0.4L * d, -2 * d, 2 * c}, 0.02L);
    const long double before = kepler_energy(run);
    ASSERT_EQ(run.advance(steps, false).status, runtime::Status::done);
    early += std::pow(static_cast<double>(kepler_energy(run) - before), 2) / starts;
    ASSERT_EQ(run.advance(15 * steps, false).status, runtime::Status::done);
    late += std::pow(static_cast<double>(kepler_energy(run) - before), 2) / starts;
  }
  EXPECT_LE(std::sqrt(late / early), 4 * 1.65);
  // A step rounds dp, of size h |p'| = 0.02/r^2 <= 0.125, and evaluates its forces with errors of a
  // few units; weighted with p <= 2: 2e-17 or so a step, times 316.
  EXPECT_LE(std::sqrt(late), 1e-14);
}

}  // namespace
}  // namespace hamgen::numerics_test
