#include "generator/program/split_constants.hpp"

#include <algorithm>

#include "generator/program/linear_terms.hpp"

namespace hamgen {

bool splits_constants(const SolvePlan& plan) {
  const ArrayPlan& arrays = *plan.arrays;
  const bool is_exact = arrays.method == ArrayMethod::newton && arrays.constant_matrix;
  return (iterates(arrays) || plan.stage_solver) && !is_exact && !plan.equations.function;
}

std::vector<Statement> split_constants(std::vector<Kernel>& kernels, const Mechanics& mechanics) {
  std::set<std::string> parameters;
  for (const Quantity& parameter : mechanics.parameters) parameters.insert(parameter.name);
  std::vector<Statement> statements;
  std::set<std::string> named;
  const auto define = [&](const std::string& name, const Expression& value, bool) {
    if (named.insert(name).second) statements.push_back({name, value});
    return Expression::symbol(name, kRankOfTemporary);
  };
  const LinearTerms::Definitions definitions{
      .in_two_parts =
          [&](const Expression& constant) {
            if (!std::ranges::includes(parameters, symbols(constant)))
              return Parts{constant, Expression(0)};
            return in_two_parts(constant, define);
          },
      .at_stage = [](const Expression& sum) { return sum; },
      .of_small_parts = [](const Expression& sum) { return sum; }};
  for (Kernel& kernel : kernels) {
    std::set<std::string> state;
    for (const Slot& slot : kernel.slots) state.insert(slot.symbol);
    const LinearTerms terms(std::move(state));
    for (Expression& slope : kernel.gradient) slope = terms.split(slope, definitions);
  }
  return statements;
}

}  // namespace hamgen
