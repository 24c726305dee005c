// What a splitting or a Runge-Kutta method leaves to be solved: nothing, or all stages together.
#include <fmt/format.h>

#include "generator/base/diagnostic.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

namespace {

// A dense matrix of this size is half a megabyte, and eliminated in some milliseconds.
constexpr std::size_t kLargestElimination = 256;

void plan_splitting(SolvePlan& plan, const Splitting& splitting) {
  auto count = [](std::size_t n, const char* what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  plan.solver = "explicit: " + count(splitting.kicks.size(), "kick") + ", " +
                count(splitting.drifts.size(), "drift");
  plan.left_out.emplace_back("equation solver: the step is explicit");
  if (splitting.kicks.size() != splitting.drifts.size()) {
    plan.left_out.push_back(
        fmt::format("the first {} of a step: it uses the gradient of the last one",
                    splitting.kick_first ? "dV/dq" : "dT/dp"));
  }
}

void plan_stages(SolvePlan& plan, const RungeKutta& tableau, const SolverWish& wish) {
  const std::size_t stages = tableau.b.size();
  if (tableau.is_explicit()) {
    plan.solver = fmt::format("explicit: {} gradient{}", stages, stages == 1 ? "" : "s");
    plan.left_out.emplace_back("equation solver: the step is explicit");
    return;
  }
  const std::size_t size =
      2 * stages * static_cast<std::size_t>(plan.equations.mechanics.degrees_of_freedom);
  using Kind = SolverWish::Kind;
  const bool of_sums = !plan.equations.mechanics.sums.empty();
  const bool newton = size <= kLargestElimination && !of_sums;
  if (wish.kind == Kind::newton && of_sums)
    throw UsageError(
        "--solver newton: H is a function of sums over all elements, whose second derivatives are "
        "not made\nhelp: --solver fixed-point");
  if (wish.kind == Kind::newton && !newton) {
    throw UsageError(
        fmt::format("--solver newton: its system has size {}, and dense elimination is "
                    "for {} at most\nhelp: --solver fixed-point, or a method with "
                    "fewer stages",
                    size, kLargestElimination));
  }
  if (of_sums) {
    plan.left_out.emplace_back("Newton's matrix: H is a function of sums over all elements");
  } else if (!newton) {
    plan.left_out.push_back(fmt::format("Newton: the system of size {} is too large", size));
  }
  plan.stage_solver = wish.kind == Kind::newton                   ? StageSolver::newton
                      : wish.kind == Kind::fixed_point || !newton ? StageSolver::fixed_point
                                                                  : StageSolver::both;
  const std::string name = fmt::format("simplified Newton of size {}", size);
  switch (*plan.stage_solver) {
    case StageSolver::newton:
      plan.solver = name;
      break;
    case StageSolver::fixed_point:
      plan.solver = fmt::format("fixed point of size {}", size);
      break;
    case StageSolver::both:
      plan.solver = fmt::format("fixed point of size {}, Newton where it contracts slowly", size);
      break;
  }
}

}  // namespace

SolvePlan plan_without_member(const StepEquations& equations, const SolverChoice& solver) {
  SolvePlan plan{.equations = equations};
  const Scheme& scheme = equations.scheme;
  const auto* tableau = std::get_if<RungeKutta>(&scheme.method);
  const bool implicit = tableau != nullptr && !tableau->is_explicit();
  if (!implicit && !solver.empty()) {
    throw UsageError(
        fmt::format("--solver {}: {} is explicit and solves nothing\nhelp: leave "
                    "--solver out",
                    solver.text(), scheme.name));
  }
  if (implicit && solver->kind == SolverWish::Kind::sweeps) {
    throw UsageError(
        fmt::format("--solver {}: {} has newton and fixed-point", solver.text(), scheme.name));
  }
  if (tableau != nullptr) plan_stages(plan, *tableau, *solver);
  if (const auto* splitting = std::get_if<Splitting>(&scheme.method)) {
    plan_splitting(plan, *splitting);
  }
  if (equations.mechanics.keeps_sums()) {
    plan.arrays = ArrayPlan{.method = ArrayMethod::gradient_only};
    plan.solver += ", in loops";
    plan.left_out.push_back(fmt::format("expansion of the sums: {} degrees of freedom stay loops",
                                        equations.mechanics.degrees_of_freedom));
  }
  return plan;
}

}  // namespace hamgen
