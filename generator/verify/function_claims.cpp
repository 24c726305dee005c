// Functions of the state: what they leave in their arrays, or return.
#include <fmt/format.h>

#include "generator/verify/emitted.hpp"

namespace hamgen {

namespace {

// z as one array, or its halves, wherever the routine wants them.
void give_state(const StepUnderProof& step, const Routine& routine, SymbolicMachine& machine) {
  const int n = step.mechanics.degrees_of_freedom;
  for (const Argument& argument : routine.arguments) {
    if (argument.sizes.empty()) continue;
    long count = 1;
    for (const int size : argument.sizes) count *= size;
    const int first = argument.name == "p" ? n : 0;
    // Of all stages, component by component.
    const int each =
        routine.name == "vector_fields" || routine.name == "forces" ? step.code.stages->room() : 1;
    // What a caller leaves in an array is zero where entries are added to it or left out, and else
    // anything.
    if (argument.changes && argument.name != "values") continue;
    for (int i = 0; i < count; ++i) {
      machine.set({argument.name, "", {{i, {}}}},
                  argument.changes ? Expression(0) : step.mechanics.variable(first + i / each));
    }
  }
}

}  // namespace

FunctionValues::FunctionValues(const StepUnderProof& step, const std::string& name)
    : machine_(step.machine()) {
  const Routine& routine = *step.code.routine(name);
  for (const Argument& argument : routine.arguments) {
    if (argument.record == "Coefficients") machine_.run("prepare");
  }
  give_state(step, routine, machine_);
  result_ = machine_.run(name);
}

Expression FunctionValues::element(const std::string& array, long i) {
  return machine_.value({array, "", {{i, {}}}});
}

Identities values_identities(const StepUnderProof& step, const std::string& routine,
                             const std::string& array, const std::string& what,
                             const std::vector<Expression>& expected) {
  FunctionValues values(step, routine);
  Identities identities{.emitted = values.definitions(), .expected = {}, .claims = {}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Expression emitted =
        array.empty() ? *values.result() : values.element(array, static_cast<long>(i));
    if (emitted.is_zero() && expected[i].is_zero() && expected.size() > 1) continue;
    identities.claims.push_back(
        {expected.size() == 1 ? what : fmt::format("{} {}", what, i + 1), emitted, expected[i]});
  }
  return identities;
}

}  // namespace hamgen
