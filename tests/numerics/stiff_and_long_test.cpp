// Stiff problems far beyond the step that would resolve them, and rounding errors over millions of
// steps.  What is measured is recorded: scripts/stress-suite takes it into docs/stability.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/numerics/emitted_run.hpp"

namespace hamgen::numerics_test {
namespace {

struct Iterations {
  int median = 0;
  int most = 0;
};

// As a property of the running test, in the XML that --gtest_output writes.
void record(const std::string& name, double value) {
  testing::Test::RecordProperty(name, fmt::format("{:.3g}", value));
}

// Throws if a step fails.
Iterations iterations_of(runtime::Integrator run, int steps) {
  std::vector<int> counts;
  for (int i = 0; i < steps; ++i) {
    const runtime::Report report = run.advance(1, false);
    if (report.status != runtime::Status::done) {
      throw std::runtime_error("step " + std::to_string(i + 1) + ": " +
                               std::string(to_text(report.status)));
    }
    counts.push_back(report.last_iterations);
  }
  std::ranges::sort(counts);
  return {counts[counts.size() / 2], counts.back()};
}

TEST(StiffAndLong, NewtonConvergesForASpringPendulumAtAHundredRadiansAStep) {
  const Emitted pendulum = Emitted::shipped("spring_pendulum", {});
  // k = 1e6, h sqrt(k) = 100.
  const Iterations iterations = iterations_of(pendulum.start({1, 0, 0, 0}, 0.1L, {1e6L}), 20000);
  record("median_iterations", iterations.median);
  record("most_iterations", iterations.most);
  EXPECT_LE(iterations.median, 6) << "most: " << iterations.most;
}

TEST(StiffAndLong, NewtonConvergesForAStiffFpuChainAtThirtyRadiansAStep) {
  const Emitted chain = Emitted::shipped("stiff_fpu", {});
  const Vector start = {1, 0, 0, 1 / 300.0L, 0, 0, 1, 0, 0, 1, 0, 0};
  const Iterations iterations = iterations_of(chain.start(start, 0.1L, {300}), 20000);
  record("median_iterations", iterations.median);
  record("most_iterations", iterations.most);
  EXPECT_LE(iterations.median, 6) << "most: " << iterations.most;
}

// Ahead of a wave each particle has moved by a millionth of what the one behind it has: an
// iteration that waited for each of them would take one for each, down to the smallest number.
TEST(StiffAndLong, AWaveIntoAChainAtRestIsNotFollowedToTheSmallestNumber) {
  const Request request = {.scheme = "gauss-4", .solver = "fixed-point", .sizes = {{"N", 200}}};
  const Emitted chain = Emitted::shipped("fput", request);
  Vector start(400);
  start[100] = 1;
  const Iterations iterations = iterations_of(chain.start(start, 0.05L), 20);
  record("most_iterations", iterations.most);
  EXPECT_LE(iterations.most, 20);
}

// Below the smallest normal number a unit of rounding is one of the smallest numbers, and a fixed
// point may go to and fro by one for ever.  `after` wants every step to succeed.
TEST(StiffAndLong, AStateOfTheSmallestNumbersHasItsFixedPoints) {
  const std::string chain =
      "size N = 5\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2)/2 + sum(i = 0..N, (q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^4/4)\n";
  const std::string oscillator = "coordinate q\nmomentum p\nH = p^2/2 + q^2/2 + q^4\n";
  for (const long double size : {1e-308L, 1e-310L, 1e-315L}) {
    Vector state;
    for (int i = 1; i <= 5; ++i) state.push_back(size * std::sin(0.3L * i));
    for (int i = 1; i <= 5; ++i) state.push_back(size * std::cos(1.0L * i));
    for (const int order : {0, 4}) {
      const Request request{.order = order, .solver = "fixed-point"};
      const Vector end = Emitted(chain, request).after(500, state, 0.05L);
      EXPECT_LT(distance(end, Vector(10)), 100 * size) << order;
    }
    const Emitted one(oscillator, {.solver = "fixed-point"});
    EXPECT_LT(distance(one.after(2000, {size, size}, 0.1L), Vector(2)), 2 * size);
  }
}

// Newton in loops, too, where nothing can be measured of squares of increments.
TEST(StiffAndLong, AStateOfTheSmallestNumbersIsSolvedByNewtonInLoops) {
  const Emitted chain(
      "size N = 26\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2 - cos(q[i])) + sum(i = 0..N, (q[i+1] - q[i])^2/2)\n",
      {.solver = "newton"});
  for (const long double size : {1e-300L, 1e-309L, 1e-312L, 1e-318L}) {
    Vector state(52);
    state[0] = size;
    EXPECT_LT(distance(chain.after(500, state, 0.1L), Vector(52)), 10 * size);
  }
}

// The midpoint rule turns (omega q, p) by theta = 2 atan(h omega/2) exactly: with x = h omega/2,
//   cos theta = (1 - x^2)/(1 + x^2),  sin theta = 2 x/(1 + x^2).
TEST(StiffAndLong, LinearModesTurnByTheExactAngleEvenAtAMillionRadiansAStep) {
  const Emitted oscillator = Emitted::shipped("harmonic", {});
  double worst = 0.0;  // in ulp
  for (const long double h_omega : {1e-3L, 1.0L, 1e3L, 1e6L}) {
    const long double h = 0.125L;
    const long double omega = h_omega / h;
    const long double x = h_omega / 2;
    for (const Vector& start : {Vector{1, 0}, Vector{0, omega}, Vector{0.7L, 0.3L * omega}}) {
      const Vector z = oscillator.after(1, start, h, {omega});
      const long double cosine = (1 - x * x) / (1 + x * x);
      const long double sine = 2 * x / (1 + x * x);
      // An ulp of the amplitude: what cancels to less cannot be known better.
      const long double amplitude = std::hypot(start[0], start[1] / omega);
      const long double ulp = std::numeric_limits<double>::epsilon() * amplitude;
      const long double q_error = std::abs(z[0] - (cosine * start[0] + sine * start[1] / omega));
      const long double p_error = std::abs(z[1] - (cosine * start[1] - sine * start[0] * omega));
      EXPECT_LE(q_error, 4 * ulp) << "h omega = " << h_omega;
      EXPECT_LE(p_error, 4 * ulp * omega) << "h omega = " << h_omega;
      worst = std::max(worst, static_cast<double>(std::max(q_error, p_error / omega) / ulp));
    }
  }
  record("largest_error_in_ulp", worst);
}

// Of the state with its carry: rounding the state itself would change the error by as much as the
// first steps do, and hide how that grows.
Quad angular_momentum(const runtime::Integrator& run) {
  const std::vector<double> z = run.rounded_state();
  const std::vector<runtime::Wide> carry = run.carry();
  const auto exact = [&](std::size_t i) { return Quad(z[i]) + carry[i].hi; };
  return exact(0) * exact(3) - exact(1) * exact(2);
}

// The midpoint rule conserves L exactly, so only rounding is left: a random walk, whose rms grows
// with the square root of the steps.  A bias of a thousandth of a rounding error would dominate at
// the end and turn the exponent to 1.  Of true random walks, looked at like these, the exponent has
// a standard deviation of 0.045 (4000 times 16 of them were drawn): four are allowed.  These 16
// starts have 0.397, 64 have 0.487.
TEST(StiffAndLong, TheAngularMomentumOfKeplerWalksAtRandom) {
  const Emitted kepler = Emitted::shipped("kepler", {});
  constexpr int starts = 16;
  constexpr long long first = 4'000'000 >> 8;
  constexpr int looks = 9;  // after first, 2 first, ..., 256 first steps
  std::vector<double> squares(looks, 0.0);
  for (int s = 0; s < starts; ++s) {
    const long double angle = 0.1L + s;  // no two the same after a quarter turn
    const long double c = std::cos(angle);
    const long double d = std::sin(angle);
    runtime::Integrator run = kepler.start({0.4L * c, 0.4L * d, -2 * d, 2 * c}, 0.01L);  // e = 0.6
    const Quad before = angular_momentum(run);
    for (int look = 0; look < looks; ++look) {
      const long long steps = look == 0 ? first : first << (look - 1);
      ASSERT_EQ(run.advance(steps, false).status, runtime::Status::done);
      const auto error = static_cast<double>(angular_momentum(run) - before);
      squares[static_cast<std::size_t>(look)] += error * error / starts;
    }
  }
  record("rms_error", std::sqrt(squares.back()));
  EXPECT_LE(std::sqrt(squares.back()), 2e-15);
  // Slope of log rms against log steps by least squares; the abscissae are -4..4 powers of two.
  double slope = 0.0;
  for (int look = 0; look < looks; ++look) {
    slope += (look - 4) * 0.5 * std::log2(squares[static_cast<std::size_t>(look)]) / 60;
  }
  record("growth_exponent", slope);
  EXPECT_NEAR(slope, 0.5, 0.18);
}

// The rule is symmetric: with -h it goes the same way back, but for rounding.  Its errors of about
// 1e-17 a step, summed at random over 2e6 steps, are sheared along the orbit, by at most
// (steps * h)/period times 2 pi times the relative change of period per energy.
TEST(StiffAndLong, AMillionStepsForthAndBackReturnToTheStart) {
  const Emitted pendulum = Emitted::shipped("pendulum", {});
  const Vector start = {0.8L, 0};
  const Vector there = pendulum.after(1'000'000, start, 0.1L);
  const Vector back = pendulum.after(1'000'000, there, -0.1L);
  record("distance", static_cast<double>(distance(back, start)));
  EXPECT_LE(distance(back, start), 1e-11L);
}

}  // namespace
}  // namespace hamgen::numerics_test
