// Members with a full matrix C against the same step by hand: no generator, no blocks, no tearing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string_view>

#include "tests/numerics/dense_step.hpp"
#include "tests/numerics/emitted_run.hpp"

namespace hamgen::numerics_test {
namespace {

using Matrix = std::vector<Vector>;

// Z by fixed-point iteration on Z = z + h J grad H(zbar), zbar = (z + Z)/2 + C (Z - z).
template <class Hamiltonian>
Vector iterated_step(const Hamiltonian& hamiltonian, const Matrix& c, long double h,
                     const Vector& z) {
  Vector next = z;
  for (int iteration = 0; iteration < 200; ++iteration) {
    Vector bar(z.size());
    for (std::size_t i = 0; i < z.size(); ++i) {
      bar[i] = (z[i] + next[i]) / 2;
      for (std::size_t j = 0; j < z.size(); ++j) bar[i] += c[i][j] * (next[j] - z[j]);
    }
    next = advanced(hamiltonian, h, z, bar);
  }
  return next;
}

const auto kCoupled = [](const std::vector<Jet<long double>>& z) {
  return 0.5L * (z[2] * z[2] + z[3] * z[3]) + z[0] * z[1] * z[1] + z[1] * z[2] +
         0.25L * (z[0] * z[0] * z[0] * z[0]) + 0.5L * (z[1] * z[1]);
};
const char* const kCoupledText =
    "coordinate x, y\nmomentum px, py\n"
    "H = (px^2 + py^2)/2 + x*y^2 + y*px + x^4/4 + y^2/2\n";

TEST(Gauge, StepsWithFullMatricesAreTheStepsByHand) {
  const Request request{.alpha = "[[1/2 + 1/8, h/4], [-1/4, 1/2]]",
                        .beta = "[[1/4, h/2], [h/2, -1/8]]",
                        .gamma = "[[1/16, -1/4], [-1/4, h]]",
                        .scalar = "long-double"};
  const long double h = 0.0625L;
  // C = [[alpha - 1/2, -gamma], [-beta, 1/2 - alpha^T]].
  const Matrix c = {{0.125L, h / 4, -0.0625L, 0.25L},
                    {-0.25L, 0, 0.25L, -h},
                    {-0.25L, -h / 2, -0.125L, 0.25L},
                    {-h / 2, 0.125L, -h / 4, 0}};
  const Vector start = {0.5L, 0.25L, -0.125L, 0.375L};
  Vector by_hand = start;
  constexpr int steps = 32;
  for (int i = 0; i < steps; ++i) by_hand = iterated_step(kCoupled, c, h, by_hand);
  const Vector emitted = Emitted(kCoupledText, request).after(steps, start, h);
  // Both solve the step to a few units of 2^-64 of values below 1; the flow over t = 2 multiplies
  // an error by exp(2 |J H''|), below 100: 32 steps * 4 units * 100 = 12800 units.
  EXPECT_LT(distance(emitted, by_hand), 12800 * 0x1p-64L);
  // The matrix matters: without its entries off the diagonals the result is another one.
  const Request diagonal{
      .alpha = "1/2 + 1/8, 1/2", .beta = "1/4, -1/8", .gamma = "1/16, h", .scalar = "long-double"};
  EXPECT_GT(distance(Emitted(kCoupledText, diagonal).after(steps, start, h), by_hand), 1e-4L);
}

TEST(Gauge, FullMatricesThatAreOddInHHaveOrderTwoAndOthersOrderOne) {
  const Vector start = {0.5L, 0.25L, -0.125L, 0.375L};
  const Vector exact = Emitted(kCoupledText, {.scalar = "long-double"}, Steps::compiled)
                           .after(1 << 14, start, 0x1p-13L);
  for (const auto& [beta, order] :
       {std::pair{"[[h, 2*h], [2*h, -h]]", 2.0}, std::pair{"[[0, 1/4], [1/4, 0]]", 1.0}}) {
    const Emitted member(kCoupledText, {.beta = beta, .scalar = "long-double"}, Steps::compiled);
    std::vector<long double> errors;
    for (int k = 5; k <= 8; ++k) {
      errors.push_back(distance(member.after(2 << k, start, std::ldexp(1.0L, -k)), exact));
    }
    EXPECT_NEAR(observed_orders(errors).back(), order, 0.1) << beta;
  }
}

// One block after another: the first is iterated, and its gradient, with what the last increment
// adds, is in the rows of the second, where it counts once and as it is at the end.
const auto kTwoBlocks = [](const std::vector<Jet<long double>>& z) {
  return 0.5L * (z[2] * z[2] + z[3] * z[3]) + 0.25L * (z[0] * z[0] * z[0] * z[0]) +
         0.25L * (z[1] * z[1] * z[1] * z[1]) + 0.5L * (z[1] * z[1]);
};
const char* const kTwoBlocksText =
    "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + (x^4 + y^4)/4 + y^2/2\n";

TEST(Gauge, ABlockTakesTheOneBeforeAsItWasLeft) {
  const Vector start = {0.5L, 0.25L, -0.125L, 0.375L};
  const long double h = 0.125L;
  for (const long double own : {0.0L, 1.0L}) {
    for (const long double other : {0.125L, 1.0L}) {
      const Request request{
          .alpha = own > 0 ? (other < 1 ? "[[1, 0], [1/8, 1/2]]" : "[[1, 0], [1, 1/2]]")
                           : (other < 1 ? "[[0, 0], [1/8, 1/2]]" : "[[0, 0], [1, 1/2]]"),
          .gamma = other < 1 ? "[[1/4, 0], [0, 0]]" : "[[1, 0], [0, 0]]",
          .scalar = "long-double"};
      const long double gamma = other < 1 ? 0.25L : 1;
      const Matrix c = {
          {own - 0.5L, 0, -gamma, 0}, {other, 0, 0, 0}, {0, 0, 0.5L - own, -other}, {0, 0, 0, 0}};
      Vector by_hand = start;
      constexpr int steps = 16;
      for (int i = 0; i < steps; ++i) by_hand = iterated_step(kTwoBlocks, c, h, by_hand);
      // As above, over t = 2.
      EXPECT_LT(distance(Emitted(kTwoBlocksText, request).after(steps, start, h), by_hand),
                12800 * 0x1p-64L)
          << static_cast<double>(own) << " " << static_cast<double>(other);
    }
  }
}

// A matrix that is constant, in equations that another block makes nonlinear.
TEST(Gauge, ALinearBlockMayFollowOthers) {
  const auto hamiltonian = [](const std::vector<Jet<long double>>& z) {
    return z[0] * z[2] + z[1] * z[3] + z[0] * z[3] - z[1] * z[2] + z[0] * z[0] * z[0];
  };
  const std::string text =
      "coordinate x, y\nmomentum px, py\nH = x*px + y*py + x*py - y*px + x^3\n";
  const Vector start = {0.5L, 0.25L, -0.125L, 0.375L};
  const Matrix midpoint(4, Vector(4));
  const Matrix c = {{0, 0.125L, 0, 0}, {-0.125L, 0, 0, 0}, {0, 0, 0, 0.125L}, {0, 0, -0.125L, 0}};
  const long double h = 0.0625L;
  constexpr int steps = 16;
  for (const bool is_midpoint : {true, false}) {
    Request request{.scalar = "long-double"};
    if (!is_midpoint) request.alpha = "[[1/2, 1/8], [-1/8, 1/2]]";
    Vector by_hand = start;
    for (int i = 0; i < steps; ++i)
      by_hand = iterated_step(hamiltonian, is_midpoint ? midpoint : c, h, by_hand);
    EXPECT_LT(distance(Emitted(text, request).after(steps, start, h), by_hand), 12800 * 0x1p-64L);
  }
}

// A linear system with its flow in closed form.
struct Linear {
  const char* text;
  std::function<Vector(const Vector&, long double)> flow;
};

std::vector<Linear> linear_systems() {
  using std::cos, std::cosh, std::exp, std::sin, std::sinh;
  return {
      {"coordinate q\nmomentum p\nH = p^2/2 + 9*q^2/2\n",
       [](const Vector& z, long double t) {
         return Vector{cos(3 * t) * z[0] + sin(3 * t) / 3 * z[1],
                       -3 * sin(3 * t) * z[0] + cos(3 * t) * z[1]};
       }},
      {"coordinate q\nmomentum p\nH = p^2/2 - q^2/2\n",
       [](const Vector& z, long double t) {
         return Vector{cosh(t) * z[0] + sinh(t) * z[1], sinh(t) * z[0] + cosh(t) * z[1]};
       }},
      {"coordinate q\nmomentum p\nH = p^2/2\n",
       [](const Vector& z, long double t) {
         return Vector{z[0] + t * z[1], z[1]};
       }},
      // A free centre of mass and an oscillation with w^2 = 2.
      {"coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + (x - y)^2/2\n",
       [](const Vector& z, long double t) {
         const long double w = std::sqrt(2.0L);
         const long double s = (z[0] + z[1]) / 2 + t * (z[2] + z[3]) / 2;
         const long double d = cos(w * t) * (z[0] - z[1]) / 2 + sin(w * t) / w * (z[2] - z[3]) / 2;
         const long double v = -w * sin(w * t) * (z[0] - z[1]) / 2 + cos(w * t) * (z[2] - z[3]) / 2;
         const long double mean = (z[2] + z[3]) / 2;
         return Vector{s + d, s - d, mean + v, mean - v};
       }},
      // One Jordan chain of four.
      {"coordinate x, y\nmomentum px, py\nH = px^2/2 + x*py\n",
       [](const Vector& z, long double t) {
         const auto [x, y, p, k] = std::array{z[0], z[1], z[2], z[3]};
         return Vector{x + p * t - k * t * t / 2, y + x * t + p * t * t / 2 - k * t * t * t / 6,
                       p - k * t, k};
       }},
      // Eigenvalues +-1 +- i: q grows in a spiral, p shrinks in one.
      {"coordinate x, y\nmomentum px, py\nH = x*px + y*py + x*py - y*px\n",
       [](const Vector& z, long double t) {
         const long double g = exp(t), c = cos(t), s = sin(t);
         return Vector{g * (c * z[0] - s * z[1]), g * (s * z[0] + c * z[1]),
                       (c * z[2] - s * z[3]) / g, (s * z[2] + c * z[3]) / g};
       }},
  };
}

TEST(LocallyExact, LinearSystemsOfEveryKindAreSolvedToRoundOffWithAnyStep) {
  const Vector start = {0.5L, -0.25L, 0.375L, 0.75L};
  constexpr int steps = 6;
  for (const Linear& system : linear_systems()) {
    Vector z = start;
    {
      const Emitted emitted(system.text, {.gauge = "locally-exact", .scalar = "long-double"});
      z.resize(2 * emitted.library().degrees_of_freedom());
      for (const long double h : {0x1p-10L, 0.125L, 0.75L, 1.25L}) {
        const Vector exact = system.flow(z, steps * h);
        // Of each of the 6 steps the entries of (I/2 + C) h A and of the solution, a few units of
        // 2^-64 each, multiplied by the condition of the step's system and by what the flow makes
        // of them: the 2^8 below stands for both; and by exp(t), exp(7.5) = 1808 at most.
        const long double unit = 0x1p-64L * std::exp(steps * h);
        EXPECT_LT(distance(emitted.after(steps, z, h), exact), 256 * steps * unit)
            << system.text << "h = " << static_cast<double>(h);
      }
    }
    const Emitted midpoint(system.text, {.scalar = "long-double"});
    // The midpoint rule is exact for the two nilpotent systems of low degree only.
    if (std::string_view(system.text).find('/') == std::string_view::npos ||
        std::string_view(system.text).find("q^2") != std::string_view::npos) {
      EXPECT_GT(distance(midpoint.after(steps, z, 0.75L), system.flow(z, steps * 0.75L)), 1e-3L)
          << system.text;
    }
  }
}

TEST(LocallyExact, TheOscillatorIsExactForStepsOfManyPeriods) {
  const Emitted emitted("coordinate q\nmomentum p\nH = p^2/2 + q^2/2\n",
                        {.gauge = "locally-exact"});
  for (const long double h : {0.001L, 0.1L, 1.0L, 3.0L, 5.0L, 10.0L, 100.0L, 1000.0L}) {
    constexpr int steps = 100;
    const long double t = steps * static_cast<long double>(static_cast<double>(h));
    const Vector end = emitted.after(steps, {1.0L, 0.0L}, static_cast<double>(h));
    // A step rounds h/2 in tan and the solution: 2^-53 (h + 16/|sin(h/2)|) of the phase and the
    // amplitude, with |sin(h/2)| > 0.13 for all of these except h = 0.001, where the coefficients
    // cancel as they grow.
    const long double bound = steps * 0x1p-53L * (h + 128);
    EXPECT_NEAR(static_cast<double>(end[0] - std::cos(t)), 0, static_cast<double>(bound))
        << static_cast<double>(h);
    EXPECT_NEAR(static_cast<double>(end[1] + std::sin(t)), 0, static_cast<double>(bound))
        << static_cast<double>(h);
  }
}

// Walls of exponentials: at the reference the frequency is 1e-9, and its gauge no difference.
TEST(LocallyExact, FrequenciesNextToZeroAreNoWorseThanOthers) {
  const std::string text =
      "coordinate q\nmomentum p\nH = p^2/2 + exp(-50*(q + 1)) + exp(50*(q - 1))\n";
  const Request exact{.gauge = "locally-exact", .reference = {{"q", "0"}}};
  Request longer = exact;
  longer.scalar = "long-double";
  const long double h = static_cast<long double>(0.02);
  const Vector start = {0, -1};
  // To and fro six times, at every wall with a rounding error of q, 2^-53, that counts 50 times in
  // the force and p, and then h in q: of a hundred steps next to walls each less than 2^-53 * 50.
  EXPECT_LT(distance(Emitted(text, exact).after(300, start, h),
                     Emitted(text, longer).after(300, start, h)),
            100 * 50 * 0x1p-53L);
}

// A spiral, whose eigenvalues are complex, from ordinary rates to such that their powers are no
// numbers: Z = exp(a h) (turned by b h) of the positions.
TEST(LocallyExact, SpiralsOfEveryRateAreSolvedInEveryScalar) {
  for (const char* scalar : {"float", "double", "quad"}) {
    const bool is_float = std::string_view(scalar) == "float";
    for (const auto& [a, b] :
         {std::pair("0.3", "1"), std::pair("2", "7"), std::pair("1e-9", "3e-9"),
          std::pair("1e-15", "1e-15"), std::pair("1e-60", "1e-60")}) {
      // Of these the square, by which the gauge goes on, is no number of float: refused.
      if (is_float && std::stold(a) < 1e-12L) continue;
      const std::string text = fmt::format(
          "coordinate x, y\nmomentum u, v\nH = {}*(x*u + y*v) + {}*(x*v - y*u)\n", a, b);
      const Vector end = Emitted(text, {.gauge = "locally-exact", .scalar = scalar})
                             .after(1, {1, 0.5L, 0, 0}, 0.5L);
      const long double grown = std::exp(0.5L * std::stold(a));
      const long double c = std::cos(0.5L * std::stold(b));
      const long double s = std::sin(0.5L * std::stold(b));
      // Some ten operations, of conditions up to 1/|cos| of what is turned: 32 units.
      const Vector exact = {grown * (c - 0.5L * s), grown * (s + 0.5L * c), 0, 0};
      EXPECT_LT(distance(end, exact), 32 * (is_float ? 0x1p-23L : 0x1p-52L))
          << scalar << ", " << a << ", " << b;
    }
  }
}

TEST(LocallyExact, NonlinearSystemsHaveOrderTwo) {
  const std::string text = "coordinate q\nmomentum p\nH = p^2/2 - cos(q)\n";
  const Vector start = {2.0L, 0.0L};
  const Emitted member(text, {.gauge = "locally-exact", .scalar = "long-double"});
  const Vector exact = member.after(1 << 15, start, 0x1p-13L);
  std::vector<long double> errors;
  for (int k = 4; k <= 7; ++k) {
    errors.push_back(distance(member.after(4 << k, start, std::ldexp(1.0L, -k)), exact));
  }
  EXPECT_NEAR(observed_orders(errors).back(), 2.0, 0.1);
}

}  // namespace
}  // namespace hamgen::numerics_test
