#include "generator/choose_sums.hpp"

#include <algorithm>
#include <variant>

#include "generator/equations/step_equations.hpp"
#include "generator/mechanics/split_sums.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

namespace {

// A matrix of this size is inverted in closed form.
constexpr int kFewUnknowns = 3;

// A row that is eliminated waits for the one before it, for the choice of a pivot and for a
// division: so many operations twice, once an iteration.
constexpr long kWaiting = 80;

// What loops take besides, for their unknowns and solutions of earlier steps lie in memory: a step
// of a chain of 5 takes 197 ns in loops and 133 ns written out, of 8 216 and 281 ns.  Less where
// they run over pairs, several of which are done at once: of three bodies it takes 98 and 174 ns.
long besides(const Mechanics& in_loops) {
  const bool has_pairs = std::ranges::any_of(
      in_loops.kernels, [](const Kernel& kernel) { return kernel.ranges.size() > 1; });
  return has_pairs ? 200 : 800;
}

long rows_eliminated(const SolvePlan& plan) {
  if (plan.arrays) {
    return plan.arrays->method == ArrayMethod::newton ? plan.arrays->matrix->size : 0;
  }
  long rows = 0;
  for (const Block& block : plan.blocks) {
    if (linear_solver(block) != LinearSolver::written_out)
      rows += static_cast<long>(block.unknowns.size());
  }
  return rows;
}

bool is_newton(const Request& request) {
  return !request.solver.empty() && request.solver->kind == SolverWish::Kind::newton;
}

long work(const Mechanics& mechanics) {
  const Scheme midpoint = for_system(*find_scheme("implicit-midpoint"), mechanics);
  const SolvePlan plan = plan_solve(discretise(mechanics, midpoint), {});
  return operations_per_step(plan) + kWaiting * rows_eliminated(plan);
}

// Does a variable that is no array stand in every summand of a sum?  t does not count unless the
// method moves it by forces.
bool couples_all_by_one(const Mechanics& mechanics, bool moves_time) {
  return std::ranges::any_of(mechanics.kernels, [&](const Kernel& kernel) {
    return std::ranges::any_of(kernel.slots, [&](const Slot& slot) {
      const bool is_time = !moves_time && mechanics.is_time(slot.position);
      return is_fixed(kernel, slot) && !is_time && slot.symbol.find('[') == std::string::npos;
    });
  });
}

}  // namespace

bool has_sums(const Model& model) {
  const std::optional<SplitSums> split = split_into_sums(model, model.hamiltonian);
  return split &&
         std::ranges::any_of(split->terms, [](const SumTerm& t) { return !t.ranges.empty(); });
}

bool asks_for_expressions(const Request& request, const Scheme& scheme) {
  const bool of_k = scheme.has_member() && scheme.member().generating_order > 0;
  return of_k || request.tangent || request.watch_modified > 0 ||
         !request.format->format->takes_loops;
}

std::string wish_for_all_second_derivatives(const Request& request) {
  if (request.tangent) return "the tangent map";
  if (request.order > 0) return "a step of higher order";
  if (request.watch_modified > 0) return "the modified energy";
  if (is_newton(request)) return "Newton's method";
  return request.format->format->takes_loops ? "" : "this format";
}

Mechanics derive_for(const Request& request, const Model& model, bool keep_sums, int most) {
  keep_sums = keep_sums && request.format->format->takes_loops;
  Mechanics mechanics = derive(model, keep_sums, most);
  const bool moves_time = !request.gamma.empty() || !request.gauge.empty();
  if (request.order > 0 && couples_all_by_one(mechanics, moves_time))
    return derive(model, false, most);
  if (mechanics.sums.empty() || wish_for_all_second_derivatives(request).empty()) return mechanics;
  return derive(model, false, most);
}

bool are_loops_quicker(const Mechanics& written_out, const Mechanics& in_loops) {
  const bool has_loops = std::ranges::any_of(
      in_loops.kernels, [](const Kernel& kernel) { return !kernel.ranges.empty(); });
  const int n = written_out.degrees_of_freedom;
  if (!has_loops || !in_loops.sums.empty() || n <= kFewUnknowns || n < in_loops.degrees_of_freedom)
    return false;
  return work(in_loops) + besides(in_loops) < work(written_out);
}

}  // namespace hamgen
