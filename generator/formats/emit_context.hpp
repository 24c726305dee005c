// What the parts of one emitted file share: how parameters and state are called in C++, and what
// has been used of the libraries so far.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "generator/formats/code_writer.hpp"
#include "generator/formats/emit_options.hpp"
#include "generator/formats/print_code.hpp"
#include "generator/formats/print_expression.hpp"
#include "generator/program/names.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

class EmitContext {
 public:
  EmitContext(const Program& program, const EmitOptions& options, const Dialect& dialect);
  EmitContext(const EmitContext&) = delete;
  EmitContext& operator=(const EmitContext&) = delete;

  const Program& program;
  const EmitOptions& options;
  const Dialect& dialect;
  const ScalarType& scalar;
  std::vector<std::string> parameter_fields;
  std::vector<std::string> state_fields;  // "q" or "q[2]": of z_1..z_2n in State
  Used used;                              // so far
  // Parameters by who reads them: H, its gradient and the invariants, or the method alone.
  Record system_parameters;
  Record method_parameters;

  [[nodiscard]] int n() const { return program.environment.degrees_of_freedom; }
  [[nodiscard]] bool arrays() const { return program.environment.arrays; }
  [[nodiscard]] bool quad() const { return scalar.digits == 113; }
  [[nodiscard]] const std::string& state_field(int i) const {
    return state_fields[static_cast<std::size_t>(i)];
  }

  // Writes the routine of this name, if there is one and it has not been written.
  void write_routine(CodeWriter& out, std::string_view name);
  // And what it calls, before it.
  void write_with_callees(CodeWriter& out, std::string_view name);
  // Does the step call it, or the tangent map that the options ask for?
  [[nodiscard]] bool needs(const std::string& routine) const { return needed_.contains(routine); }

 private:
  void split_parameters();

  std::set<std::string> needed_;
  std::set<std::string, std::less<>> written_;
};

// "[2][2]" of an array.
[[nodiscard]] std::string sizes_text(const Field& field);

}  // namespace hamgen
