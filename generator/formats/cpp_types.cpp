// The structs of an emitted file.
#include <fmt/format.h>

#include <algorithm>

#include "generator/formats/cpp_context.hpp"
#include "generator/formats/numerics.hpp"

namespace hamgen {

namespace {

std::string remark(const Quantity& quantity) {
  std::string text = quantity.comment;
  std::ranges::replace(text, '\\', '/');
  if (!quantity.unit.empty()) text += (text.empty() ? "[" : " [") + quantity.unit + "]";
  return text;
}

void write_struct(CodeWriter& out, const std::string& name, const std::vector<CppGroup>& groups,
                  bool defaults, const ScalarType& scalar) {
  if (groups.empty()) {
    out.line("struct " + name + " {};");
    return;
  }
  out.open("struct " + name);
  std::vector<std::pair<std::string, std::string>> members;
  for (const CppGroup& g : groups) {
    const Quantity& first = *g.elements.front();
    if (g.is_array) {
      std::string values;
      for (const Quantity* element : g.elements) {
        if (!defaults) break;
        values += (values.empty() ? "" : ", ") + literal(element->value, scalar);
      }
      members.emplace_back(fmt::format("Real {}[{}] = {{{}}};", g.name, g.elements.size(), values),
                           remark(first));
    } else {
      members.emplace_back(fmt::format("Real {} = {};", g.name,
                                       literal(defaults ? first.value : Rational(0), scalar)),
                           remark(first));
    }
  }
  out.aligned(members);
  out.close(";");
}

}  // namespace

void write_types(CodeWriter& out, CppContext& context, bool with_vocabulary) {
  write_struct(out, "Parameters", context.parameter_groups, true, context.scalar);
  out.line();
  write_struct(out, "State", context.state_groups, false, context.scalar);
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
  if (!with_vocabulary) return;
  out.lines(cpp_vocabulary(context.scalar, context.options.builtins));
  context.functions.insert("fabs");
}

}  // namespace hamgen
