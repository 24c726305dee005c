#include "generator/program/kernel_evaluation.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "generator/program/lower.hpp"
#include "generator/program/names.hpp"

namespace hamgen {

KernelEvaluation evaluate(const Kernel& kernel, const std::vector<Expression>& values,
                          const Substitution& indices) {
  const std::vector<Expression> wanted = substitute(values, indices);
  std::set<std::string> used;
  for (const Expression& value : wanted) collect_symbols(value, used);
  const bool has_fixed = std::ranges::any_of(kernel.slots, [&](const Slot& slot) {
    return is_fixed(kernel, slot) && used.contains(slot.symbol);
  });
  if (!has_fixed) return {evaluate_together(wanted), {}};
  std::set<std::string> inside = varying_symbols(kernel);
  for (const auto& [name, symbol] : indices) inside.insert(symbol.name());
  for (const ParameterSlot& slot : kernel.parameters) inside.insert(slot.symbol);
  Lowering lowering({Section{}, Section{.is_loop = true}});
  for (const std::string& symbol : used) lowering.declare(symbol, inside.contains(symbol) ? 1 : 0);
  std::vector<std::size_t> handles;
  for (const Expression& value : wanted) handles.push_back(lowering.want(value, 1));
  lowering.run();
  KernelEvaluation result{{.statements = lowering.statements(1)}, lowering.statements(0)};
  for (const std::size_t handle : handles) result.results.push_back(lowering.wanted(handle));
  return result;
}

std::string loop_index(const Routine& routine, const std::string& name) {
  const bool taken =
      name == "n" || name == "sum" ||
      std::ranges::find(routine.arguments, name, &Argument::name) != routine.arguments.end();
  return taken ? name + "_index" : identifier(name);
}

AffineIndex renamed(const Routine& routine, const AffineIndex& index) {
  AffineIndex result{index.constant, {}};
  for (const auto& [name, factor] : index.factors)
    result.factors[loop_index(routine, name)] = factor;
  return result;
}

}  // namespace hamgen
