// What a list of statements costs, by kind of operation.
#include <fmt/format.h>

#include <algorithm>

#include "generator/program/arithmetic.hpp"
#include "generator/program/build_program.hpp"
#include "generator/program/code_cost.hpp"
#include "generator/program/lowered_step.hpp"

namespace hamgen {

namespace {

void add_cost(const Expression& e, Cost& total) {
  for (const Expression& operand : e.operands()) {
    if (!operand.is_number()) add_cost(operand, total);
  }
  switch (e.kind()) {
    case Kind::number:
    case Kind::symbol:
      return;
    case Kind::sum:
      total.additions += static_cast<long>(e.operands().size()) - 1;
      return;
    case Kind::function:
      if (e.name() == kProductError) {
        total.additions += 10;
        total.multiplications += 7;
      } else if (e.name() == kDifferenceError) {
        total.additions += 6;
      } else {
        ++total.functions;
      }
      return;
    case Kind::power:
      if (e.operands()[1] == Expression(-1)) {
        ++total.divisions;
      } else if (e.operands()[1].is_number() && e.operands()[1].number().get_den() == 1) {
        ++total.multiplications;
      } else {
        ++total.functions;
      }
      return;
    case Kind::product: {
      int factors = 0;
      bool reciprocal = false;
      for (const Expression& operand : e.operands()) {
        const bool divides =
            operand.kind() == Kind::power && operand.operands()[1] == Expression(-1);
        reciprocal = reciprocal || divides;
        if (!divides && operand != Expression(-1)) ++factors;
      }
      total.multiplications += std::max(0, factors - 1);
      return;
    }
  }
}

}  // namespace

Cost cost(const std::vector<Statement>& statements) {
  Cost total;
  for (const Statement& statement : statements) add_cost(statement.value, total);
  return total;
}

namespace {

constexpr long kIterations = 2;

long operations_of(const Cost& total) {
  return total.additions + total.multiplications + 10 * (total.divisions + total.functions);
}
long operations_of(const std::vector<Statement>& statements) {
  return operations_of(cost(statements));
}

// Of a solve: what its body takes, and elimination where that is not written out.
long operations_of(const Solve& solve) {
  const auto size = static_cast<long>(solve.matrix.size());
  return operations_of(solve.body) + size * size * size / 3 + 2 * size * size;
}

long operations_of_member(const LoweredStep& lowered) {
  long total = 0;
  for (const Stage& stage : lowered.stages) {
    total += operations_of(stage.before) + operations_of(stage.after);
    if (stage.solve) total += kIterations * operations_of(*stage.solve);
  }
  return total;
}

long operations_in_loops(const SolvePlan& plan) {
  const StepCost cost = step_cost(build_program(plan));
  return kIterations * operations_of(cost.iteration) + operations_of(cost.besides);
}

}  // namespace

long operations_per_step(const SolvePlan& plan) {
  const LoweredStep lowered = lower_step(plan);
  const Scheme& scheme = lowered.plan.equations.scheme;
  const auto variables = static_cast<long>(lowered.increments.size());
  if (const auto* splitting = std::get_if<Splitting>(&scheme.method)) {
    const auto parts = static_cast<long>(splitting->kicks.size());
    return parts * (operations_of(lowered.potential_gradient.statements) +
                    operations_of(lowered.kinetic_gradient.statements) +
                    4L * lowered.plan.equations.mechanics.degrees_of_freedom);
  }
  if (const auto* tableau = std::get_if<RungeKutta>(&scheme.method)) {
    const auto stages = static_cast<long>(tableau->b.size());
    return stages * (operations_of(lowered.vector_field.statements) +
                     stages * 2L * lowered.plan.equations.mechanics.degrees_of_freedom);
  }
  const auto substeps = std::max<long>(1, static_cast<long>(lowered.sequence.substeps.size()));
  if (plan.arrays)
    return substeps *
           (operations_in_loops(plan) + 12L * plan.equations.mechanics.degrees_of_freedom);
  return substeps * (operations_of_member(lowered) + 6 * variables);
}

std::string to_text(const Cost& cost) {
  std::string text;
  auto add = [&](long count, const char* what) {
    if (count != 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(cost.additions + cost.multiplications, "+ - *");
  add(cost.divisions, "/");
  add(cost.functions, "sqrt and functions");
  return text.empty() ? "nothing" : text;
}

}  // namespace hamgen
