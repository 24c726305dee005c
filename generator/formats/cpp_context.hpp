// What the parts of one emitted file share: how parameters and state are called in C++, and what
// has been used of the libraries so far.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "generator/formats/code_writer.hpp"
#include "generator/formats/cpp_expression.hpp"
#include "generator/formats/cpp_header.hpp"
#include "generator/program/names.hpp"

namespace hamgen {

// Elements of one declared name: a scalar member or an array member of a struct.
struct CppGroup {
  std::string name;  // of the member
  bool is_array = false;
  std::vector<const Quantity*> elements;
};

class CppContext {
 public:
  CppContext(const Program& program, const CppOptions& options);
  CppContext(const CppContext&) = delete;  // the groups point into its lists
  CppContext& operator=(const CppContext&) = delete;

  const Program& program;
  const CppOptions& options;
  const ScalarType& scalar;
  const StepEquations& equations;
  const Mechanics& mechanics;
  std::vector<Quantity> variables;
  std::vector<Quantity> parameters;  // E0 last, if the scheme uses it
  std::vector<CppGroup> parameter_groups;
  std::vector<CppGroup> state_groups;
  std::vector<std::string> parameter_fields;
  std::vector<std::string> state_fields;              // "q" or "q[2]": of z_1..z_2n in State
  std::map<std::string, std::string> parameter_text;  // "eps" is par.eps
  std::set<std::string> functions;                    // of <cmath>, used so far
  bool uses_pi = false;

  [[nodiscard]] int n() const { return mechanics.degrees_of_freedom; }
  [[nodiscard]] bool arrays() const { return program.plan.arrays.has_value(); }
  [[nodiscard]] bool quad() const { return scalar.digits == 113; }
  [[nodiscard]] const std::string& state_field(int i) const {
    return state_fields[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] const std::string& variable_name(int i) const {
    return mechanics.variables[static_cast<std::size_t>(i)].name;
  }

  // A namer for one function: parameters as par.x, the rest as locals.
  [[nodiscard]] CppExpression expression(Names& names);
  // What the expressions called decides the includes.
  void note(const CppExpression& cpp);

  // Locals for the state variables that the statements use, from z.q or from an array z[0].
  enum class StateForm { fields, array };
  void load_state(CodeWriter& out, Names& names, const std::set<std::string>& used,
                  StateForm form = StateForm::fields) const;
};

// Writes them one by one; those in `declared` are assigned to, the rest are new constants.
void write_statements(CodeWriter& out, const CppExpression& cpp, Names& names,
                      const std::vector<Statement>& statements,
                      const std::set<std::string>& declared = {});
[[nodiscard]] std::set<std::string> used_symbols(const std::vector<Statement>& statements);

// The types Parameters, State, StepReport; what cpp_numerics() needs if `with_vocabulary`.
void write_types(CodeWriter& out, CppContext& context, bool with_vocabulary);

}  // namespace hamgen
