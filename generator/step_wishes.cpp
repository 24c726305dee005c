#include "generator/step_wishes.hpp"

#include <algorithm>
#include <set>

#include "generator/algebra/scalar.hpp"
#include "generator/modified_terms.hpp"
#include "generator/program/without_tangent.hpp"
#include "generator/read_request.hpp"

namespace hamgen {

namespace {

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

}  // namespace

StepWishes step_wishes(const Request& request, const Specialised& system, const SolvePlan& plan,
                       bool for_scene) {
  const int digits = request.scalar->type->digits;
  StepWishes wishes{
      .tangent = request.tangent && !without_tangent(plan),
      .plain_sums = request.plain_sums,
      .unchecked = request.batch == 0 && for_scene && fails_nowhere(system.mechanics, plan),
      .stages_in_lanes = digits == 53 && request.batch == 0,
      .trajectories_in_lanes = request.batch > 0};
  if (request.watch_modified > 0) {
    require_solved_step(request);
    wishes.modified_terms = modified_terms(system.mechanics, system.scheme, request.watch_modified);
  }
  return wishes;
}

std::vector<std::string> left_out_by(const StepWishes& wishes) {
  std::vector<std::string> list;
  if (wishes.plain_sums)
    list.emplace_back("compensated sums: rounding takes up to half a unit of the state a step");
  if (wishes.unchecked)
    list.emplace_back("a look at every step: H is a polynomial, explicit steps leave no domain");
  return list;
}

}  // namespace hamgen
