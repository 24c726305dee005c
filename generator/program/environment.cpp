#include "generator/program/environment.hpp"

#include <fmt/format.h>

#include "generator/equations/step_equations.hpp"

namespace hamgen {

Environment environment_of(const StepEquations& equations, bool arrays) {
  const Mechanics& mechanics = equations.mechanics;
  Environment result{.degrees_of_freedom = mechanics.degrees_of_freedom,
                     .arrays = arrays,
                     .parameters = mechanics.parameters,
                     .variables = mechanics.variables,
                     .parameter_layout = {},
                     .state_layout = {}};
  if (uses_energy_parameter(equations)) {
    result.parameters.push_back({"E0", "", "energy of the initial state: set it before use", 0});
  }
  result.parameter_layout = layout("Parameters", result.parameters, Defaults::values);
  result.state_layout = arrays ? array_state(result.variables)
                               : layout("State", result.variables.elements(), Defaults::none);
  return result;
}

Place Environment::place(const std::string& state, int i) const {
  return state_layout.in(state, static_cast<std::size_t>(i));
}

Expression Environment::bind_state(Routine& routine, const std::string& state, int i) const {
  const Place where = place(state, i);
  const std::string symbol = to_text(where);
  routine.places.insert_or_assign(symbol, where);
  return Expression::symbol(symbol, kRankOfVariable + i);
}

void Environment::bind_parameters(Routine& routine) const {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    routine.places.insert_or_assign(parameters[i].name, parameter_layout.in("par", i));
  }
}

void Environment::load_state(Routine& routine, Body& body,
                             const std::set<std::string>& used) const {
  for (int i = 0; i < 2 * degrees_of_freedom; ++i) {
    const std::string& name = variables.name(static_cast<std::size_t>(i));
    if (used.contains(name)) body.push_back({Let{name, bind_state(routine, "z", i)}});
  }
}

Argument parameters_argument() { return {.name = "par", .record = "Parameters"}; }

Argument state_argument(const std::string& name, bool changes) {
  return {.name = name, .record = "State", .changes = changes};
}

Expression bind_element(Routine& routine, const std::string& array,
                        const std::vector<int>& indices) {
  Place place{.object = array};
  std::string symbol = array;  // "values(0,1)": no name of the user's looks like that
  for (const int index : indices) {
    symbol += fmt::format("{}{}", place.indices.empty() ? '(' : ',', index);
    place.indices.push_back({.constant = index, .factors = {}});
  }
  symbol += ')';
  routine.places.insert_or_assign(symbol, place);
  return Expression::symbol(symbol, kRankOfTemporary);
}

void append(Body& body, const std::vector<Statement>& statements) {
  for (const Statement& s : statements) body.push_back({Let{s.name, s.value}});
}

std::set<std::string> used_symbols(const std::vector<Statement>& statements) {
  std::set<std::string> used;
  for (const Statement& s : statements) collect_symbols(s.value, used);
  return used;
}

}  // namespace hamgen
