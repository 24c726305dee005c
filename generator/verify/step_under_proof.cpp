#include "generator/verify/step_under_proof.hpp"

#include "generator/base/diagnostic.hpp"

namespace hamgen {

SymbolicMachine StepUnderProof::machine(std::set<std::string> opaque) const {
  SymbolicMachine machine(code, std::move(opaque));
  for (int i = 0; i < size(); ++i) {
    machine.reserve(mechanics.variables.name(static_cast<std::size_t>(i)));
    machine.set(environment.place("z", i), mechanics.variable(i));
    machine.set(environment.place("carry", i), carry(i));
    machine.set(environment.place("dz", i), Expression(0));
    machine.set(environment.place("rest", i), Expression(0));
  }
  for (std::size_t i = 0; i < environment.parameters.size(); ++i) {
    const std::string& parameter = environment.parameters[i].name;
    const int rank = parameter == "E0" ? kRankOfStep : kRankOfParameter + static_cast<int>(i);
    machine.reserve(parameter);
    machine.set(environment.parameter_layout.in("par", i), Expression::symbol(parameter, rank));
  }
  return machine;
}

Expression StepUnderProof::component(const std::vector<Expression>& input, int i, int first) const {
  if (static_cast<int>(input.size()) < size()) return input.at(static_cast<std::size_t>(i - first));
  const Place place = environment.place("", i);
  std::size_t position = 0;
  for (const Field& field : environment.state_layout.record.fields) {
    if (field.name == place.field) {
      const long element = place.indices.empty() ? 0 : place.indices.front().constant;
      return input.at(position + static_cast<std::size_t>(element));
    }
    std::size_t count = 1;
    for (const int length : field.sizes) count *= static_cast<std::size_t>(length);
    position += count;
  }
  internal_error("a component of no field");
}

Expression StepUnderProof::increment(SymbolicMachine& machine, int i) const {
  return machine.value(environment.place("dz", i)) + machine.value(environment.place("rest", i));
}

}  // namespace hamgen
