// The extrapolation of a rule whose expansion is known.
#include "runtime/extrapolation.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace hamgen::runtime {
namespace {

__extension__ typedef __float128 Quad113;

constexpr int most_coefficients = 13;

// After a time H in steps of h: q + H (1 + c_1 h^2 + c_2 h^4 + ...), p - H; where h is larger than
// the largest step, no step is done.  The parameters are c_1, c_2, ... and the largest step.
struct ExpandedRun {
  std::vector<double> parameters;
  Quad113 h = 0, q = 0, p = 0;
};

ExpandedRun& expanded(hamgen_run* run) { return *reinterpret_cast<ExpandedRun*>(run); }

hamgen_run* create_expanded(const double* parameters, const double*, double h, double h_lo,
                            const double* z, const double* lo) {
  return reinterpret_cast<hamgen_run*>(
      new ExpandedRun{{parameters, parameters + most_coefficients + 1},
                      Quad113(h) + Quad113(h_lo),
                      Quad113(z[0]) + Quad113(lo[0]),
                      Quad113(z[1]) + Quad113(lo[1])});
}

void destroy_expanded(hamgen_run* run) { delete &expanded(run); }

void advance_expanded(hamgen_run* run, long long steps, int, hamgen_report* report) {
  ExpandedRun& at = expanded(run);
  *report = {};
  if (at.h > at.parameters.back()) {
    report->status = HAMGEN_NOT_CONVERGED;
    return;
  }
  const Quad113 time = Quad113(steps) * at.h;
  Quad113 factor = 0;
  for (std::size_t k = most_coefficients; k-- > 0;)
    factor = at.h * at.h * (at.parameters[k] + factor);
  factor += 1;
  at.q += time * factor;
  at.p -= time;
  report->steps_done = steps;
}

void state_expanded(const hamgen_run* run, double* z, double* lo) {
  const ExpandedRun& at = *reinterpret_cast<const ExpandedRun*>(run);
  z[0] = static_cast<double>(at.q);
  z[1] = static_cast<double>(at.p);
  if (lo == nullptr) return;
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
                                     .parameter_count = most_coefficients + 1,
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

// From (1/4, 2), stopped beyond the end or after a hundred steps.
Extrapolation extrapolated(const std::vector<double>& coefficients, double tolerance,
                           int first_parts = 1, double largest_step = 100) {
  std::vector<Wide> parameters(most_coefficients + 1);
  for (std::size_t k = 0; k < coefficients.size(); ++k) parameters[k].hi = coefficients[k];
  parameters.back().hi = largest_step;
  const auto library = std::make_shared<const Library>(expanded_rule, nullptr);
  int steps = 0;
  std::atomic<bool> stop = false;
  return extrapolate(library, {.parameters = parameters, .h = {1, 0}, .state = {{0.25, 0}, {2, 0}}},
                     {1, 0x1p-60},
                     {.tolerance = tolerance,
                      .first_parts = first_parts,
                      .on_progress = [&](double done) { stop = done > 1 || ++steps > 100; },
                      .stop = &stop});
}

// The end is no double: 1 + 2^-60.
void expect_limit(const Extrapolation& result, double tolerance) {
  EXPECT_EQ(result.failure, "");
  const Quad113 time = 1 + Quad113(0x1p-60);
  const Quad113 q = Quad113(result.state[0].hi) + Quad113(result.state[0].lo);
  const Quad113 p = Quad113(result.state[1].hi) + Quad113(result.state[1].lo);
  EXPECT_NEAR(static_cast<double>(q - Quad113(0.25) - time), 0, tolerance);
  EXPECT_NEAR(static_cast<double>(p - 2 + time), 0, tolerance);
}

// Row j of the scheme, the rule with 1, ..., j steps, removes j - 1 terms of the expansion: with
// k terms the last two numbers of row k + 2 are both the limit, and those of no row before.
TEST(Extrapolation, RemovesOneTermOfTheExpansionWithEveryRow) {
  for (std::size_t terms = 2; terms <= 11; ++terms) {
    SCOPED_TRACE(terms);
    const Extrapolation result = extrapolated(std::vector<double>(terms, 1.0), 1e-27);
    expect_limit(result, 1e-27);
    EXPECT_EQ(result.steps, 1);
    const auto rows = static_cast<long long>(terms) + 2;
    EXPECT_EQ(result.solves, rows * (rows + 1) / 2);
  }
}

// With 13 terms the last row of a step of 1 is not exact; of a half, they are 2^-26 of it.
TEST(Extrapolation, HalvesAStepThatIsTooLargeAndStillReachesTheEnd) {
  const Extrapolation result = extrapolated(std::vector<double>(13, 1.0), 1e-27);
  expect_limit(result, 1e-26);
  EXPECT_GE(result.steps, 2);
}

// -5/4 h^2 + h^4 is -1/4 both for h = 1 and for h = 1/2; the end is 1e-18 off.
TEST(Extrapolation, IsNotDeceivedByTwoNumbersThatAgreeByChance) {
  expect_limit(extrapolated({-1.25, 1}, 1e-15), 1e-27);
}

// After 1/3 in four rows the step is 2/3, and then all that is left of 1, never more.
TEST(Extrapolation, EndsWhereItIsToldTo) {
  for (const int parts : {2, 3, 5}) {
    SCOPED_TRACE(parts);
    const Extrapolation result = extrapolated({1, 1}, 1e-27, parts);
    expect_limit(result, 1e-26);
    EXPECT_EQ(result.steps, parts == 5 ? 3 : 2);
  }
}

// Only with a quarter is there a step; each takes four rows, 10 steps of the rule.
TEST(Extrapolation, HalvesAStepThatTheRuleDoesNotSolve) {
  const Extrapolation result = extrapolated({1, 1}, 1e-27, 1, 0.25 + 0x1p-50);
  expect_limit(result, 1e-26);
  EXPECT_EQ(result.steps, 4);
  EXPECT_EQ(result.solves, 40);
}

}  // namespace
}  // namespace hamgen::runtime
