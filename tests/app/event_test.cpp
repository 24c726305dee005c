// Crossings: found to rounding, of the order of the step.
#include "app/studies/event.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/app/interpreted_orbit.hpp"

namespace hamgen::app_test {
namespace {

using app::Crossing;
using app::Direction;
using app::EventLocator;

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
  const EventLocator locator(orbit->library, orbit->start, 0, Direction::both);
  runtime::Integrator integrator(orbit->library, orbit->start);
  auto before = integrator.state();
  for (int step = 0; step < 100'000; ++step) {
    EXPECT_EQ(integrator.advance(1, false).status, runtime::Status::done);
    const auto after = integrator.state();
    const auto crossing = locator.within(before, before[0].hi, after, after[0].hi);
    if (crossing) {
      Found found{.time = h * (step + crossing->fraction), .value = crossing->state[0].hi};
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
  const std::vector<runtime::Wide> left = {{-0.01, 0.0}, {1.0, 0.0}};
  const std::vector<runtime::Wide> right = {{0.09, 0.0}, {0.99, 0.0}};
  const auto crosses = [&](Direction direction, double from, double to) {
    const EventLocator locator(orbit->library, orbit->start, 0, direction);
    return locator.within(left, from, right, to).has_value();
  };
  EXPECT_TRUE(crosses(Direction::rising, -0.01, 0.09));
  EXPECT_FALSE(crosses(Direction::falling, -0.01, 0.09));
  EXPECT_TRUE(crosses(Direction::both, -0.01, 0.09));
  EXPECT_FALSE(crosses(Direction::both, 0.01, 0.09));
  // A zero belongs to the step that ends there.
  EXPECT_TRUE(crosses(Direction::rising, -0.01, 0.0));
  EXPECT_FALSE(crosses(Direction::rising, 0.0, 0.09));
}

}  // namespace
}  // namespace hamgen::app_test
