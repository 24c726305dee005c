// Crossings: found to rounding, of the order of the step.
#include "runtime/event.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/app/interpreted_orbit.hpp"

namespace hamgen::app_test {
namespace {

using runtime::Crossing;
using runtime::Direction;
using runtime::EventLocator;
using State = std::vector<runtime::Wide>;

// Of the first invariant.
EventLocator locator_of(const InterpretedOrbit& orbit, Direction direction) {
  const auto value = [&orbit](std::span<const runtime::Wide> state) {
    return orbit.library->invariants(orbit.start.parameters, state)[0].hi;
  };
  return {orbit.library, orbit.start, value, direction};
}

// q = cos(t), p = -sin(t).
constexpr const char* kOscillator =
    "system oscillator\ncoordinate q\nmomentum p\nH = p^2/2 + q^2/2\ninvariant at = q\n"
    "scene unit { q = 1 }\n";

struct Found {
  double time = 0.0;
  double value = 0.0;  // of the quantity there
  double by_polynomial = 0.0;
};

// The first time at which q vanishes: pi/2.  And what the cubic through both ends and slopes says.
Found first_zero(const std::string& scheme, double h) {
  const auto orbit = interpreted_orbit(kOscillator, scheme, std::to_string(h));
  const EventLocator locator = locator_of(*orbit, Direction::both);
  runtime::Integrator integrator(orbit->library, orbit->start);
  auto before = integrator.state();
  for (int step = 0; step < 100'000; ++step) {
    EXPECT_EQ(integrator.advance(1, false).status, runtime::Status::done);
    const auto after = integrator.state();
    const auto crossings = locator.within(before, before[0].hi, after, after[0].hi);
    if (!crossings.empty()) {
      EXPECT_EQ(crossings.size(), 1U);
      const Crossing& crossing = crossings[0];
      Found found{.time = h * (step + crossing.fraction), .value = crossing.state[0].hi};
      double low = 0.0;
      double high = 1.0;
      for (int i = 0; i < 60; ++i) {
        const double s = 0.5 * (low + high);
        const double cubic = (1 + 2 * s) * (1 - s) * (1 - s) * before[0].hi +
                             s * (1 - s) * (1 - s) * h * before[1].hi +
                             s * s * (3 - 2 * s) * after[0].hi - s * s * (1 - s) * h * after[1].hi;
        ((cubic > 0.0) == (before[0].hi > 0.0) ? low : high) = s;
      }
      found.by_polynomial = h * (step + low);
      return found;
    }
    before = after;
  }
  ADD_FAILURE() << "no crossing";
  return {};
}

double error(double time) { return std::abs(time - std::numbers::pi / 2); }

TEST(Event, HasTheOrderOfTheStepWhereAPolynomialHasItsOwn) {
  for (const auto& [scheme, order, h] : {std::tuple{"implicit-midpoint", 2, 0.1},
                                         {"stormer-verlet", 2, 0.1},
                                         {"yoshida-4", 4, 0.1},
                                         {"gauss-4", 4, 0.1},
                                         {"gauss-6", 6, 0.2},
                                         {"gauss-8", 8, 0.4}}) {
    const Found coarse = first_zero(scheme, h);
    const Found fine = first_zero(scheme, h / 2);
    const double measured = std::log2(error(coarse.time) / error(fine.time));
    EXPECT_NEAR(measured, order, 0.3) << scheme;
    if (order <= 4) continue;
    // The negative control: its error is that of a cubic.
    EXPECT_GT(error(fine.by_polynomial), 10 * error(fine.time)) << scheme;
  }
}

TEST(Event, IsARootToRounding) {
  for (const char* scheme : {"implicit-midpoint", "gauss-6", "symplectic-euler-a"}) {
    for (const double h : {0.3, 0.07}) {
      EXPECT_LE(std::abs(first_zero(scheme, h).value), 4e-16) << scheme << h;
    }
  }
}

TEST(Event, KnowsItsDirection) {
  const auto orbit = interpreted_orbit(kOscillator, "gauss-4", "0.1");
  const State left = {{-0.01, 0.0}, {1.0, 0.0}};
  const auto right = runtime::part_of_step(orbit->library, orbit->start, left, {1.0, 0.0});
  ASSERT_TRUE(right);
  const auto crosses = [&](Direction direction, double sign, double line) {
    const auto value = [=](std::span<const runtime::Wide> state) {
      return sign * (state[0].hi - line);
    };
    return !EventLocator(orbit->library, orbit->start, value, direction)
                .within(left, value(left), *right, value(*right))
                .empty();
  };
  EXPECT_TRUE(crosses(Direction::rising, 1, 0));
  EXPECT_FALSE(crosses(Direction::falling, 1, 0));
  EXPECT_TRUE(crosses(Direction::both, 1, 0));
  EXPECT_TRUE(crosses(Direction::falling, -1, 0));
  EXPECT_FALSE(crosses(Direction::rising, -1, 0));
  EXPECT_FALSE(crosses(Direction::both, 1, 0.2));
  // A zero belongs to the step that ends there.
  EXPECT_TRUE(crosses(Direction::rising, 1, (*right)[0].hi));
  EXPECT_FALSE(crosses(Direction::rising, 1, left[0].hi));
}

// A step from just before a turn to just behind it crosses a line below the turn twice; the signs
// at its ends are the same.
TEST(Event, FindsTwoCrossingsInOneStep) {
  const auto orbit = interpreted_orbit(kOscillator, "gauss-8", "0.6");
  for (const double depth : {0.04, 0.01, 1e-3, 1e-6, 1e-9}) {
    // q = cos(t) from t = -0.3 to 0.3, against 1 - depth: at t = -+acos(1 - depth).
    const State before = {{std::cos(0.3), 0.0}, {std::sin(0.3), 0.0}};
    const auto after = runtime::part_of_step(orbit->library, orbit->start, before, {1.0, 0.0});
    ASSERT_TRUE(after);
    const auto value = [depth](std::span<const runtime::Wide> state) {
      return state[0].hi - (1.0 - depth);
    };
    const auto within = [&](Direction direction) {
      return EventLocator(orbit->library, orbit->start, value, direction)
          .within(before, value(before), *after, value(*after));
    };
    const auto both = within(Direction::both);
    ASSERT_EQ(both.size(), 2U) << depth;
    const double t = std::acos(1.0 - depth);
    // A relative error of rounding in depth is one of half as much in t; the step's own is 1e-10.
    const double tolerance = 1e-9 + 4e-16 / t;
    EXPECT_NEAR(both[0].fraction, 0.5 - t / 0.6, tolerance) << depth;
    EXPECT_NEAR(both[1].fraction, 0.5 + t / 0.6, tolerance) << depth;
    const auto rising = within(Direction::rising);
    ASSERT_EQ(rising.size(), 1U) << depth;
    EXPECT_EQ(rising[0].fraction, both[0].fraction);
    EXPECT_EQ(within(Direction::falling).size(), 1U);
  }
  // The negative control: a line above the turn is not crossed.
  const auto above = [](std::span<const runtime::Wide> state) { return state[0].hi - 1.001; };
  const State before = {{std::cos(0.3), 0.0}, {std::sin(0.3), 0.0}};
  const auto after = runtime::part_of_step(orbit->library, orbit->start, before, {1.0, 0.0});
  EXPECT_TRUE(EventLocator(orbit->library, orbit->start, above, Direction::both)
                  .within(before, above(before), *after, above(*after))
                  .empty());
}

// Three and more: cos(8 t) over a step of 0.6 changes its sign twice, with q = cos(t).
TEST(Event, FindsManyCrossingsInTheirOrder) {
  const auto orbit = interpreted_orbit(kOscillator, "gauss-8", "0.6");
  const State before = {{1.0, 0.0}, {0.0, 0.0}};
  const auto after = runtime::part_of_step(orbit->library, orbit->start, before, {1.0, 0.0});
  const auto value = [](std::span<const runtime::Wide> state) {
    return std::cos(8.0 * std::atan2(-state[1].hi, state[0].hi));
  };
  const auto found = EventLocator(orbit->library, orbit->start, value, Direction::both)
                         .within(before, value(before), *after, value(*after));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].fraction * 0.6, std::numbers::pi / 16, 1e-9);
  EXPECT_NEAR(found[1].fraction * 0.6, 3 * std::numbers::pi / 16, 1e-9);
}

}  // namespace
}  // namespace hamgen::app_test
