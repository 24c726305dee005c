// What the parts of one emitted file share: how parameters and state are called in C++, and what
// has been used of the libraries so far.
#pragma once

#include <string>
#include <vector>

#include "generator/base/code_writer.hpp"
#include "generator/formats/emit_options.hpp"
#include "generator/formats/print_code.hpp"
#include "generator/formats/print_expression.hpp"
#include "generator/program/contents.hpp"
#include "generator/program/names.hpp"

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
  const Contents contents;

  [[nodiscard]] int n() const { return program.environment.degrees_of_freedom; }
  [[nodiscard]] bool arrays() const { return program.environment.arrays; }
  // Of stages that are computed together, or 0.
  [[nodiscard]] int stage_lanes() const { return program.stages ? program.stages->packs() : 0; }
  [[nodiscard]] bool quad() const { return scalar.digits == 113; }
  [[nodiscard]] const std::string& state_field(int i) const {
    return state_fields[static_cast<std::size_t>(i)];
  }
};

// "[2][2]" of an array.
[[nodiscard]] std::string sizes_text(const Field& field);

}  // namespace hamgen
