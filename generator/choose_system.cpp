#include "generator/choose_system.hpp"

#include <fmt/format.h>

#include "generator/choose_scheme.hpp"
#include "generator/choose_sums.hpp"
#include "generator/equations/step_equations.hpp"
#include "generator/mechanics/curvature.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/read_request.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

namespace {

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

}  // namespace

Specialised choose_system(const Model& model, const std::optional<SceneFacts>& scene,
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

}  // namespace hamgen
