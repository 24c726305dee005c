#include "generator/formats/cpp_step.hpp"

#include <fmt/format.h>

#include "generator/formats/cpp_matrices.hpp"

namespace hamgen {

namespace {

std::string initial_value(const Field& field, const ScalarType& scalar) {
  std::string values;
  for (const Rational& value : field.values) {
    const std::string text = field.type == "int"                            ? value.get_str()
                             : field.type != "bool" && field.type != "Mask" ? literal(value, scalar)
                             : value == 0                                   ? "false"
                                                                            : "true";
    values += (values.empty() ? "" : ", ") + text;
  }
  if (!field.sizes.empty()) return " = {" + values + "}";
  if (!values.empty()) return " = " + values;
  return field.type == "Real" ? " = " + literal(0, scalar) : "";
}

}  // namespace

void write_record(CodeWriter& out, const Record& record, const ScalarType& scalar,
                  const std::string& base) {
  for (const std::string& line : record.remark) out.remark("// ", line);
  const std::string head = "struct " + record.name + (base.empty() ? "" : " : " + base);
  if (record.fields.empty()) return out.line(head + " {};");
  out.open(head);
  std::vector<std::pair<std::string, std::string>> members;
  for (const Field& field : record.fields) {
    members.emplace_back(fmt::format("{} {}{}{};", field.type, field.name, sizes_text(field),
                                     initial_value(field, scalar)),
                         field.remark);
  }
  out.aligned(members);
  out.close(";");
}

void write_solver(CodeWriter& out, EmitContext& context) {
  if (context.program.matrix) write_matrix(out, *context.program.matrix);
  if (const Record* coefficients = context.program.record("Coefficients")) {
    write_record(out, *coefficients, context.scalar);
    out.line();
    context.write_with_callees(out, "prepare");
  }
  if (const Record* start = context.program.record("Start")) {
    write_record(out, *start, context.scalar);
    out.line();
  }
  context.write_with_callees(out, "solve");
}

}  // namespace hamgen
