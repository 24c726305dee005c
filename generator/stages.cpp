#include "generator/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "generator/algebra/scalar.hpp"
#include "generator/base/budget.hpp"
#include "generator/choose_scheme.hpp"
#include "generator/choose_sums.hpp"
#include "generator/mechanics/curvature.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/modified_terms.hpp"
#include "generator/program/build_program.hpp"
#include "generator/program/without_tangent.hpp"
#include "generator/read_request.hpp"

namespace hamgen {

namespace {

// Parameters that serve a scene only, or nothing: no emitted line names them.
void drop_unused_parameters(StepEquations& equations) {
  Mechanics& mechanics = equations.mechanics;
  if (mechanics.keeps_sums()) return;
  std::set<std::string> used;
  collect_symbols(mechanics.energy, used);
  for (const Expression& component : mechanics.gradient) collect_symbols(component, used);
  for (const auto& [place, value] : mechanics.hessian) collect_symbols(value, used);
  for (const NamedExpression& invariant : mechanics.invariants) {
    collect_symbols(invariant.value, used);
  }
  for (const auto& [place, value] : equations.stage_matrix) collect_symbols(value, used);
  std::erase_if(mechanics.parameters,
                [&](const Quantity& parameter) { return !used.contains(parameter.name); });
}

Specialised make_system(const Model& model, const std::optional<SceneFacts>& scene,
                        const Request& request, bool keep_sums,
                        Variables variables = Variables::changed, int most = kMostWrittenOut) {
  require_few_coupled(model, request);
  Mechanics mechanics = derive_for(request, model, keep_sums, most);
  if (request.observe_curvature) mechanics.invariants = energy_curvature(mechanics);
  Scheme scheme = choose_scheme(model, mechanics, request);
  return specialise(model, std::move(mechanics), std::move(scheme), scene, variables);
}

// What a system costs a step; an integrator whose derivatives are not written out counts for
// nothing.
long operations(const Specialised& system, const Request& request) {
  const HessianWish hessian = request.tangent ? HessianWish::exact : HessianWish::cheapest;
  return operations_per_step(
      plan_solve(discretise(system.mechanics, system.scheme, hessian), request.solver));
}

// The system in the variables in which a step has fewer operations.
Specialised choose_variables(const Model& model, const std::optional<SceneFacts>& scene,
                             const Request& request) {
  Specialised changed = make_system(model, scene, request, may_keep_sums(request));
  if (changed.changes.empty()) return changed;
  Specialised plain =
      make_system(model, scene, request, may_keep_sums(request), Variables::as_they_are);
  const long before = operations(plain, request);
  const long after = operations(changed, request);
  if (after < before) return changed;
  for (const LinearChange& change : changed.changes) {
    plain.left_out.push_back(fmt::format("{}; not used: a step would have {} operations, not {}",
                                         change.left_out.back(), after, before));
  }
  return plain;
}

// A system that may be written out stays loops where these are quicker.
Specialised choose_sums(const Model& model, const std::optional<SceneFacts>& scene,
                        const Request& request) {
  if (request.in_loops)
    return make_system(model, scene, request, may_keep_sums(request), Variables::as_they_are, 0);
  Specialised system = choose_variables(model, scene, request);
  const bool has_choice = !system.mechanics.keeps_sums() && may_keep_sums(request) &&
                          has_sums(model) && !asks_for_expressions(request, system.scheme);
  if (!has_choice) return system;
  Specialised loops = make_system(model, scene, request, true, Variables::as_they_are, 0);
  return are_loops_quicker(system.mechanics, loops.mechanics) ? loops : system;
}

bool is_polynomial(const Mechanics& mechanics) {
  const auto is_free_of = [](const Expression& e, const std::set<std::string>& variables) {
    const std::set<std::string> others = non_polynomial_symbols(e);
    return std::ranges::none_of(
        others, [&](const std::string& symbol) { return variables.contains(symbol); });
  };
  std::set<std::string> variables;
  if (!mechanics.keeps_sums()) {
    for (const Quantity& variable : mechanics.variables) variables.insert(variable.name);
  }
  for (const Kernel& kernel : mechanics.kernels) {
    for (const Slot& slot : kernel.slots) variables.insert(slot.symbol);
  }
  return is_free_of(mechanics.energy, variables) &&
         std::ranges::all_of(mechanics.kernels, [&](const Kernel& kernel) {
           return is_free_of(kernel.value, variables);
         });
}

// Does every step have a value, as far as numbers go?
bool fails_nowhere(const Mechanics& mechanics, const SolvePlan& plan) {
  const Method& method = plan.equations.scheme.method;
  const auto* tableau = std::get_if<RungeKutta>(&method);
  const auto array = plan.arrays ? plan.arrays->method : ArrayMethod::gradient_only;
  const bool is_explicit =
      std::holds_alternative<Splitting>(method) || (tableau != nullptr && tableau->is_explicit()) ||
      (std::holds_alternative<Member>(method) && !plan.equations.function &&
       (plan.arrays ? array == ArrayMethod::explicit_a || array == ArrayMethod::explicit_b
                    : plan.is_explicit()));
  return is_explicit && mechanics.sums.empty() && is_polynomial(mechanics);
}

Stages stages_of(Model model, const Request& request) {
  require_defaults_in_range(model, *request.scalar->type);
  FoldedModel folded = fold_for_scene(model, request);
  const std::optional<SceneFacts> scene = scene_facts(model, request);
  Specialised system = choose_sums(folded.model, scene, request);
  const HessianWish hessian = request.tangent ? HessianWish::exact : HessianWish::cheapest;
  StepEquations equations = discretise(system.mechanics, system.scheme, hessian);
  const bool eigen = request.scalar->type->digits < 113;  // it does not know quad numbers
  SolvePlan plan = plan_solve(equations, request.solver, eigen);
  drop_unused_parameters(plan.equations);
  equations.mechanics.parameters = plan.equations.mechanics.parameters;
  system.mechanics.parameters = plan.equations.mechanics.parameters;
  std::vector<std::string> left_out = folded.folding.left_out;
  left_out.insert(left_out.end(), system.left_out.begin(), system.left_out.end());
  plan.left_out.insert(plan.left_out.begin(), left_out.begin(), left_out.end());
  if (request.plain_sums)
    plan.left_out.emplace_back(
        "compensated sums: rounding takes up to half a unit of the state a step");
  const bool unchecked = request.batch == 0 && scene && fails_nowhere(system.mechanics, plan);
  if (unchecked)
    plan.left_out.emplace_back(
        "a look at every step: H is a polynomial, explicit steps leave no domain");
  StepWishes wishes{.tangent = request.tangent && !without_tangent(plan),
                    .plain_sums = request.plain_sums,
                    .unchecked = unchecked,
                    .stages_in_lanes = request.scalar->type->digits == 53 && request.batch == 0,
                    .trajectories_in_lanes = request.batch > 0};
  if (request.watch_modified > 0) {
    require_solved_step(request);
    wishes.modified_terms = modified_terms(system.mechanics, system.scheme, request.watch_modified);
  }
  Program program = build_program(plan, wishes);
  return {std::move(model),     std::move(folded), std::move(system),
          std::move(equations), std::move(plan),   std::move(program)};
}

}  // namespace

Stages run_stages(const SourceText& source, const Request& request) {
  const Budget budget;
  const Model model = read_request(source, request);
  try {
    return stages_of(model, request);
  } catch (const OverBudget& error) {
    throw over_budget(error, model.hamiltonian->span, source);
  }
}

bool is_something_left_out(const Stages& stages) {
  return !stages.folded.folding.left_out.empty() || !stages.system.left_out.empty();
}

Expression written_out_hamiltonian(const Stages& stages) {
  const Specialised& system = stages.system;
  return system.mechanics.keeps_sums() ? restrict_to(written_out_hamiltonian(stages.folded.model),
                                                     system.whole, system.kept, system.left)
                                       : system.mechanics.energy;
}

}  // namespace hamgen
