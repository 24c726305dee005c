// What the routines of one program have in common: where parameters and state stand.
#pragma once

#include <string>
#include <vector>

#include "generator/program/code.hpp"
#include "generator/program/records.hpp"
#include "generator/program/statement.hpp"

namespace hamgen {

struct StepEquations;

struct Environment {
  int degrees_of_freedom = 0;
  bool arrays = false;               // q and p are two arrays
  std::vector<Quantity> parameters;  // E0 last, if the step uses it
  QuantityList variables;            // 2n
  Layout parameter_layout;           // of record Parameters
  Layout state_layout;               // of record State

  // The place of z_i in a state of this name; as a symbol, "z.q".
  [[nodiscard]] Place place(const std::string& state, int i) const;
  // Binds the symbol of z_i in a state, and returns it.
  [[nodiscard]] Expression bind_state(Routine& routine, const std::string& state, int i) const;
  // Binds the parameters to the argument par.
  void bind_parameters(Routine& routine) const;
  // Locals for the components of z that the symbols name.
  void load_state(Routine& routine, Body& body, const std::set<std::string>& used) const;
};

[[nodiscard]] Environment environment_of(const StepEquations& equations, bool arrays);

// par, and a state of this name.
[[nodiscard]] Argument parameters_argument();
[[nodiscard]] Argument state_argument(const std::string& name, bool changes = false);

// Binds the symbol of an element of an array, and returns it.
[[nodiscard]] Expression bind_element(Routine& routine, const std::string& array,
                                      const std::vector<int>& indices);

// Each statement as a local.
void append(Body& body, const std::vector<Statement>& statements);
[[nodiscard]] std::set<std::string> used_symbols(const std::vector<Statement>& statements);

}  // namespace hamgen
