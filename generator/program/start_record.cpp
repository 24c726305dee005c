#include "generator/program/start_record.hpp"

#include <fmt/format.h>

#include "generator/program/coefficients.hpp"

namespace hamgen {

bool is_compared(const Solve& solve) {
  return solve.linear_solver == LinearSolver::elimination && !solve.simplified &&
         !solve.constant_matrix && form_of(solve) == MatrixForm::symmetric;
}

namespace {

std::string type_of_newton(const Solve& solve) {
  const int power = solve.simplified ? 1 : 2;
  const std::size_t unknowns = solve.variables.size();
  if (unknowns == 1) return fmt::format("NewtonRule<{}>", power);
  if (is_compared(solve)) return fmt::format("NewtonRuleWithMatrix<{}>", unknowns);
  return fmt::format("NewtonRuleOfMany<{}, {}>", power, unknowns);
}

}  // namespace

Record start_record(const std::vector<const Solve*>& solves, int unknowns) {
  Record start{
      .name = "Start",
      .fields = {{.name = "value", .sizes = {unknowns}},
                 {.name = "known",
                  .remark = "else the state itself is the start",
                  .values = {0},
                  .type = "bool"}},
      .remark = {
          "Start values of the implicit equations and what is remembered of their solution."}};
  for (std::size_t s = 0; s < solves.size(); ++s) {
    if (solves[s] == nullptr || solves[s]->kind != BlockKind::newton) continue;
    start.fields.push_back({.name = fmt::format("rule_{}", s), .type = type_of_newton(*solves[s])});
  }
  return start;
}

std::vector<RuleOfNewton> rules_of(const Routine& solve) {
  std::vector<RuleOfNewton> rules;
  for (const Instruction& instruction : solve.body) {
    const auto* iterate = std::get_if<Iterate>(&instruction.value);
    if (iterate == nullptr || iterate->rule != Rule::newton) continue;
    rules.push_back({iterate->name, iterate->unknowns.front().memory,
                     static_cast<int>(iterate->unknowns.size())});
  }
  return rules;
}

}  // namespace hamgen
