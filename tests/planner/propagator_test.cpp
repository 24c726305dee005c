// What a run keeps from step to step, and what a step does with it.
#include <gtest/gtest.h>

#include "generator/base/source_text.hpp"
#include "generator/pipeline.hpp"

namespace hamgen {
namespace {

constexpr const char* kSwing = "system swing\ncoordinate q\nmomentum p\nH = p^2/2 - cos(q)\n";
constexpr const char* kQuartic = "system quartic\ncoordinate q\nmomentum p\nH = p^2/2 + q^4/4\n";

// The routine of this name in what `show --stage program` prints.
std::string shown(const std::string& routine, const Request& request = {},
                  const std::string& model = kSwing) {
  const std::string text = show_stage(make_source("test.ham", model), request, "program");
  const auto begin = text.find("\n" + routine + "(");
  if (begin == std::string::npos) return "not found in\n" + text;
  auto end = text.find('\n', begin + 1);
  while (end + 1 < text.size() && text[end + 1] == ' ') end = text.find('\n', end + 1);
  return text.substr(begin + 1, end - begin);
}

TEST(Propagator, TriesAgainFromTheState) {
  EXPECT_EQ(shown("step", {}, kQuartic), R"(step():
  new State: dz, rest
  self.start.known <- self.history.known > 0
  if self.start.known:
    History.extrapolate(self.history, self.start.value)
  report <- solve(self.par, self.k, self.h, self.z, self.carry, self.start, dz, rest)
  if not report.converged and self.start.known:
    wasted = report.iterations
    self.start <- new Start
    report <- solve(self.par, self.k, self.h, self.z, self.carry, self.start, dz, rest)
    report.iterations += wasted
  if not report.converged:
    return report
  NewtonRule.watch(self.start.rule_0, self.history, self.start.value, 0, 1)
  History.record(self.history, self.start.value)
  two_sum_with_rest(self.z.q, self.carry.q, dz.q, rest.q)
  two_sum_with_rest(self.z.p, self.carry.p, dz.p, rest.p)
  self.steps += 1
  return report
)");
}

// Where the solutions before this step predict the next one, of a step that has ended well.
TEST(Propagator, EvaluatesTheNextStepsDerivativesAhead) {
  const std::string step = shown("step");
  const std::size_t failed = step.find("    return report\n");
  const std::size_t ahead = step.find(R"(  if self.start.known:
    History.extrapolate_twice(self.history, self.at.point)
    derivatives(self.par, self.at)
    self.at.ready <- true
  History.record(self.history, self.start.value)
)");
  ASSERT_NE(ahead, std::string::npos) << step;
  EXPECT_LT(failed, ahead) << step;
  EXPECT_NE(shown("reset").find("self.at <- new Derivatives\n"), std::string::npos)
      << shown("reset");
  const std::string solve = shown("solve");
  const std::size_t loop = solve.find("iterate with Newton's rule:");
  const std::size_t taken = solve.find(R"(    if at.ready:
      bar(q) <- at.point[0]
    if not at.ready:
      at.point[0] <- bar(q)
      derivatives(par, at)
    at.ready <- false
)");
  ASSERT_NE(taken, std::string::npos) << solve;
  EXPECT_LT(loop, taken) << solve;
}

TEST(Propagator, ForgetsWhatTheSubstepsOfAStepThatFailedHaveSeen) {
  EXPECT_EQ(shown("step", {.scheme = "yoshida-4"}), R"(step():
  z <- self.z
  carry <- self.carry
  new StepReport: total
  substeps times:
    report <- substep(i, z, carry)
    total.iterations += report.iterations
    total.increment <- report.increment
    if not report.converged:
      each self.start <- new Start
      each self.history <- new History
      return total
  self.z <- z
  self.carry <- carry
  self.steps += 1
  total.converged <- true
  return total
)");
}

// Of a step that fails nothing is known, whatever has become of its stages: what they start from is
// read before, and they are known again where the step ends well.
TEST(Propagator, TakesNothingOfAStepThatFailed) {
  const std::string solve = shown("solve", {.scheme = "gauss-4"});
  const std::size_t used = solve.find("if start.known:");
  const std::size_t forgotten = solve.find("\n  start.known <- false\n");
  const std::size_t iterated = solve.find("iterate");
  ASSERT_NE(forgotten, std::string::npos) << solve;
  EXPECT_LT(used, forgotten) << solve;
  EXPECT_LT(forgotten, iterated) << solve;
}

// What the fixed point gave up is no start for Newton, nor known to be one for the next step; a
// constant matrix is factorised once.
TEST(Propagator, StartsNewtonOfAnArrayFromTheState) {
  const std::string chain =
      "system chain\nsize N = 40\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^";
  const std::string solve = shown("solve", {}, chain + "4)\n");
  const std::string between = "  else, for 32 steps:\n";
  const std::size_t second = solve.find(between);
  ASSERT_NE(second, std::string::npos) << solve;
  const std::size_t forgotten = solve.find("    start.known <- false\n", second);
  ASSERT_NE(forgotten, std::string::npos) << solve;
  EXPECT_LT(forgotten, solve.find("    newton(", second)) << solve;
  const std::string linear = shown("solve", {.solver = "newton"}, chain + "2)\n");
  const std::size_t fresh = linear.find("if not start.factorised:\n");
  ASSERT_NE(fresh, std::string::npos) << linear;
  const std::size_t factorised = linear.find("factorise start.matrix\n", fresh);
  EXPECT_LT(factorised, linear.find("start.factorised <- true\n", fresh)) << linear;
  EXPECT_LT(linear.find("start.factorised <- true\n"), linear.find("solve start.matrix")) << linear;
}

TEST(Propagator, BeginsAnew) {
  EXPECT_EQ(shown("reset", {.scheme = "yoshida-4"}), R"(reset(z):
  self.z <- z
  self.carry <- new State
  self.steps <- 0
  each self.start <- new Start
  each self.history <- new History
)");
}

// Of an explicit step nothing is remembered.
TEST(Propagator, OfAnExplicitStepOnlyAddsUp) {
  EXPECT_EQ(shown("step", {.scheme = "symplectic-euler-a", .plain_sums = true}), R"(step():
  new State: dz
  report <- solve(self.par, self.h, self.z, dz)
  if not report.converged:
    return report
  self.z.q += dz.q
  self.z.p += dz.p
  self.steps += 1
  return report
)");
}

}  // namespace
}  // namespace hamgen
