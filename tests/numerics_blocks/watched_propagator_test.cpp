// Steps that are looked into, around an oscillator whose steps are its flow.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test::watched_oscillator {
namespace {

using Real = double;
using of_double::cubic_between;
using of_double::find_crossings;
using of_double::magnitude;
using of_double::StepReport;
template <int count>
using CrossingList = of_double::CrossingList<count>;
constexpr Real largest = 1e308;

struct Parameters {
  Real last = 100;  // the time at which steps begin to fail
};
struct State {
  Real q = 0, p = 1;
};

class Propagator {
 public:
  Propagator(const Parameters& par, Real h, const State& z) : par_(par), h_(h), z_(z) {}
  StepReport step() {
    const Real angle = std::atan2(z_.q, z_.p);
    StepReport report;
    report.converged = time_ + h_ <= par_.last;
    report.iterations = 3;
    report.increment = h_;
    if (!report.converged) return report;
    time_ += h_;
    z_ = {std::sin(angle + h_), std::cos(angle + h_)};
    return report;
  }
  void reset(const State& z) {
    z_ = z;
    time_ = 0;
  }
  const State& state() const { return z_; }
  const Parameters& parameters() const { return par_; }
  Real time() const { return time_; }
  Real h() const { return h_; }

 private:
  Parameters par_;
  Real h_;
  State z_;
  Real time_ = 0;
};

void gradient(const Parameters&, const State& z, Real (&values)[2]) {
  values[0] = z.q;
  values[1] = z.p;
}
void events(const Parameters&, const State& z, Real (&values)[2]) {
  values[0] = z.q - 0.5;
  values[1] = z.p;
}

enum class Event { half, turn };
struct Watched {
  static constexpr int variables = 2;
  static constexpr int events = 2;
  static constexpr bool rising[events] = {true, true};
  static constexpr bool falling[events] = {false, true};
  static State cubic(Real s, Real h, const State& a, const Real (&at_a)[variables], const State& b,
                     const Real (&at_b)[variables]) {
    return {cubic_between(s, h, a.q, at_a[1], b.q, at_b[1]),
            cubic_between(s, h, a.p, -at_a[0], b.p, -at_b[0])};
  }
};

#include "generator/numerics/shells/watched_propagator.hpp"

const Real pi = std::acos(-1.0);

std::vector<Crossing> crossings(WatchedPropagator& watched, long long steps) {
  std::vector<Crossing> found;
  EXPECT_TRUE(watched
                  .advance(steps,
                           [&](const Crossing& crossing) {
                             found.push_back(crossing);
                             return false;
                           })
                  .converged);
  return found;
}

TEST(WatchedPropagator, FindsCrossingsInTheOrderOfTimeAndOfTheirDirection) {
  WatchedPropagator watched(Propagator({}, 0.7, {}));
  const std::vector<Crossing> found = crossings(watched, 10);
  const std::vector<Real> times = {pi / 6, pi / 2, 3 * pi / 2, 2 * pi + pi / 6};
  const std::vector<Event> kinds = {Event::half, Event::turn, Event::turn, Event::half};
  ASSERT_EQ(found.size(), times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_EQ(found[i].event, kinds[i]);
    EXPECT_NEAR(found[i].time, times[i], 1e-14);
    EXPECT_NEAR(found[i].state.q, std::sin(times[i]), 1e-14);
    EXPECT_NEAR(std::fmod(found[i].time, 0.7), 0.7 * found[i].theta, 1e-14);
  }
  EXPECT_FALSE(watched.ended());
}

TEST(WatchedPropagator, SeveralInOneStep) {
  WatchedPropagator watched(Propagator({}, 2, {}));
  const std::vector<Crossing> found = crossings(watched, 1);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].time, pi / 6, 1e-14);
  EXPECT_NEAR(found[1].time, pi / 2, 1e-14);
}

TEST(WatchedPropagator, EndsInTheStepInWhichTheVisitorSaysSo) {
  WatchedPropagator watched(Propagator({}, 2, {}));
  int calls = 0;
  const StepReport report = watched.advance(9, [&](const Crossing&) { return ++calls == 1; });
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 3);
  EXPECT_TRUE(watched.ended());
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(watched.propagator().time(), 2);
  EXPECT_EQ(watched.advance(3, [](const Crossing&) { return false; }).iterations, 9);
  EXPECT_FALSE(watched.ended());
}

TEST(WatchedPropagator, InAFailedStepNothingIsLookedFor) {
  WatchedPropagator watched(Propagator({.last = 0.5}, 0.4, {}));
  int calls = 0;
  const auto count = [&](const Crossing&) { return ++calls < 0; };
  const StepReport report = watched.advance(9, count);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 6);
  EXPECT_EQ(report.increment, 0.4);
  EXPECT_EQ(calls, 0);
  // As far into it as a part of it succeeds.
  State z{7, 7};
  EXPECT_TRUE(watched.at(0.5, z).converged);
  EXPECT_NEAR(z.q, std::sin(0.4 + 0.2), 1e-15);
}

TEST(WatchedPropagator, GoesBackIntoTheLastStepAndBeginsAnew) {
  WatchedPropagator watched(Propagator({}, 0.25, {}));
  crossings(watched, 4);
  State z;
  EXPECT_TRUE(watched.at(0, z).converged);
  EXPECT_NEAR(z.q, std::sin(0.75), 1e-15);
  EXPECT_TRUE(watched.at(1, z).converged);
  EXPECT_EQ(z.q, watched.propagator().state().q);
  watched.reset({});
  EXPECT_EQ(watched.propagator().time(), 0);
  EXPECT_TRUE(watched.at(0, z).converged);
  EXPECT_EQ(z.q, 0);
  EXPECT_EQ(crossings(watched, 3).size(), 1U);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test::watched_oscillator
