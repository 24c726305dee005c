#include "generator/program/collective_loops.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace hamgen {

bool run_beside(const Kernel& a, const Kernel& b) {
  return a.sum && b.sum && a.ranges == b.ranges && a.slots == b.slots &&
         a.parameters == b.parameters;
}

Evaluation evaluate_apart(const std::vector<Expression>& values, const std::string& name) {
  Evaluation evaluation = evaluate_together(values);
  Substitution renamed;
  for (Statement& statement : evaluation.statements) {
    const std::string own = fmt::format("{}({})", name, renamed.size() + 1);
    statement.value = substitute(statement.value, renamed);
    renamed.emplace(statement.name, Expression::symbol(own, kRankOfTemporary));
    statement.name = own;
  }
  evaluation.results = substitute(evaluation.results, renamed);
  return evaluation;
}

std::vector<Kernel> weighted_kernels(const Mechanics& mechanics) {
  std::vector<Kernel> list;
  for (Kernel kernel : mechanics.kernels) {
    if (!kernel.sum) {
      list.push_back(std::move(kernel));
      continue;
    }
    const Expression slope =
        Expression::symbol(mechanics.sums[*kernel.sum].slope, kRankOfTemporary);
    for (Expression& each : kernel.gradient) each = each * slope;
    const auto beside =
        std::ranges::find_if(list, [&](const Kernel& other) { return run_beside(kernel, other); });
    if (beside == list.end()) {
      list.push_back(std::move(kernel));
      continue;
    }
    for (std::size_t i = 0; i < kernel.gradient.size(); ++i)
      beside->gradient[i] += kernel.gradient[i];
    beside->terms.merge(kernel.terms);
  }
  return list;
}

}  // namespace hamgen
