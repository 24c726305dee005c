// The structs of an emitted file.
#include <fmt/format.h>

#include <algorithm>

#include "generator/formats/cpp_context.hpp"
#include "generator/formats/cpp_support.hpp"

namespace hamgen {

namespace {

std::string remark(const Field& field) {
  std::string text = field.remark;
  std::ranges::replace(text, '\\', '/');
  return text;
}

void write_struct(CodeWriter& out, const Record& record, const ScalarType& scalar) {
  if (record.fields.empty()) {
    out.line("struct " + record.name + " {};");
    return;
  }
  out.open("struct " + record.name);
  std::vector<std::pair<std::string, std::string>> members;
  for (const Field& field : record.fields) {
    std::string values;
    for (const Rational& value : field.values) {
      values += (values.empty() ? "" : ", ") + literal(value, scalar);
    }
    if (field.length > 0) {
      members.emplace_back(fmt::format("Real {}[{}] = {{{}}};", field.name, field.length, values),
                           remark(field));
    } else {
      members.emplace_back(
          fmt::format("Real {} = {};", field.name, values.empty() ? literal(0, scalar) : values),
          remark(field));
    }
  }
  out.aligned(members);
  out.close(";");
}

}  // namespace

void write_types(CodeWriter& out, CppContext& context, bool with_magnitude) {
  write_struct(out, context.environment.parameter_layout.record, context.scalar);
  out.line();
  write_struct(out, context.environment.state_layout.record, context.scalar);
  out.line();
  out.line(
      "// On failure the increment says how far the iteration was from its end; it is not finite");
  out.line("// where the step left the domain of H.");
  out.open("struct StepReport");
  out.line("bool converged = false;");
  out.line("long long iterations = 0;");
  out.line(fmt::format("Real increment = {};", literal(0, context.scalar)));
  out.close(";");
  out.line();
  if (!with_magnitude) return;
  out.lines(cpp_magnitude(context.scalar, context.options.builtins) + "\n");
  context.used.functions.insert("fabs");
}

}  // namespace hamgen
