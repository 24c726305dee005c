// The extrapolation of a rule whose expansion is known.
#include "runtime/extrapolation.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hamgen::runtime {
namespace {

__extension__ typedef __float128 Quad113;

// After a time H in steps of h: q + H (1 + h^2 + h^4 + ... + h^(2 terms)), p - H.
struct ExpandedRun {
  int terms = 0;
  Quad113 h = 0, q = 0, p = 0;
};

ExpandedRun& expanded(hamgen_run* run) { return *reinterpret_cast<ExpandedRun*>(run); }

hamgen_run* create_expanded(const double* parameters, const double*, double h, double h_lo,
                            const double* z, const double* lo) {
  return reinterpret_cast<hamgen_run*>(
      new ExpandedRun{static_cast<int>(parameters[0]), Quad113(h) + Quad113(h_lo),
                      Quad113(z[0]) + Quad113(lo[0]), Quad113(z[1]) + Quad113(lo[1])});
}

void destroy_expanded(hamgen_run* run) { delete &expanded(run); }

void advance_expanded(hamgen_run* run, long long steps, int, hamgen_report* report) {
  ExpandedRun& at = expanded(run);
  const Quad113 time = Quad113(steps) * at.h;
  Quad113 factor = 0;
  for (int k = 0; k <= at.terms; ++k) factor = 1 + at.h * at.h * factor;
  at.q += time * factor;
  at.p -= time;
  *report = {};
  report->steps_done = steps;
}

void state_expanded(const hamgen_run* run, double* z, double* lo) {
  const ExpandedRun& at = *reinterpret_cast<const ExpandedRun*>(run);
  z[0] = static_cast<double>(at.q);
  z[1] = static_cast<double>(at.p);
  lo[0] = static_cast<double>(at.q - Quad113(z[0]));
  lo[1] = static_cast<double>(at.p - Quad113(z[1]));
}

void carry_expanded(const hamgen_run*, double* carry, double* lo) {
  carry[0] = carry[1] = lo[0] = lo[1] = 0;
}

double energy_expanded(const double*, const double*, const double*, const double*, double* lo) {
  if (lo != nullptr) *lo = 0;
  return 1;
}

void gradient_expanded(const double*, const double*, double* gradient) {
  gradient[0] = gradient[1] = 1;
}

const hamgen_plugin expanded_rule = {.version = HAMGEN_PLUGIN_VERSION,
                                     .degrees_of_freedom = 1,
                                     .parameter_count = 1,
                                     .scalar_digits = 113,
                                     .description = "a rule with a finite expansion",
                                     .solver = "explicit",
                                     .create = create_expanded,
                                     .destroy = destroy_expanded,
                                     .advance = advance_expanded,
                                     .get_state = state_expanded,
                                     .get_carry = carry_expanded,
                                     .energy = energy_expanded,
                                     .gradient = gradient_expanded};

Extrapolation extrapolated(int terms, ExtrapolationOptions options) {
  const auto library = std::make_shared<const Library>(expanded_rule, nullptr);
  // An end that is no double: 1 + 2^-60.
  return extrapolate(
      library,
      {.parameters = {{static_cast<double>(terms), 0}}, .h = {1, 0}, .state = {{0.25, 0}, {2, 0}}},
      {1, 0x1p-60}, options);
}

// Row j of the scheme, the rule with 1, ..., j steps, removes j - 1 terms of the expansion: with
// k terms the last two numbers of row k + 2 are both the limit, and those of no row before.
TEST(Extrapolation, RemovesOneTermOfTheExpansionWithEveryRow) {
  for (int terms = 2; terms <= 11; ++terms) {
    const Extrapolation result = extrapolated(terms, {.tolerance = 1e-27, .first_parts = 1});
    EXPECT_EQ(result.failure, "") << terms;
    EXPECT_EQ(result.steps, 1) << terms;
    const int rows = terms + 2;
    EXPECT_EQ(result.solves, rows * (rows + 1) / 2) << terms;
    const Quad113 q = Quad113(result.state[0].hi) + Quad113(result.state[0].lo);
    const Quad113 p = Quad113(result.state[1].hi) + Quad113(result.state[1].lo);
    const Quad113 time = 1 + Quad113(0x1p-60);
    EXPECT_NEAR(static_cast<double>(q - Quad113(0.25) - time), 0, 1e-27) << terms;
    EXPECT_NEAR(static_cast<double>(p - 2 + time), 0, 1e-27) << terms;
  }
}

// With 13 terms the last row of a step of 1 is not exact; of a half, they are 2^-26 of it.
TEST(Extrapolation, HalvesAStepThatIsTooLargeAndStillReachesTheEnd) {
  const Extrapolation result = extrapolated(13, {.tolerance = 1e-27, .first_parts = 1});
  EXPECT_EQ(result.failure, "");
  EXPECT_GE(result.steps, 2);
  const Quad113 q = Quad113(result.state[0].hi) + Quad113(result.state[0].lo);
  EXPECT_NEAR(static_cast<double>(q - Quad113(1.25) - Quad113(0x1p-60)), 0, 1e-26);
}

}  // namespace
}  // namespace hamgen::runtime
