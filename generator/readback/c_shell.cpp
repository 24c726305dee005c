#include "generator/readback/c_shell.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

std::string sizes_of(const Field& field) {
  std::string sizes;
  for (const int size : field.sizes) sizes += fmt::format("[{}]", size);
  return sizes;
}

std::string type_of(const std::string& type) {
  if (type.starts_with("NewtonRule")) return "hamgen::NewtonRule";
  if (type.starts_with("History")) return "N::History";
  const bool plain = type == "Real" || type == "bool" || type == "int" || type == "long long";
  return plain ? type : "N::" + type;
}

std::string value_of(const Beginning& beginning, const std::string& from) {
  if (!beginning.routine.empty()) return fmt::format("N::{}(par, {})", beginning.routine, from);
  return (beginning.record.empty() ? "" : "*") + from;
}

Pattern make_pattern(const Propagator& propagator) {
  const std::size_t parts = propagator.fractions.size();
  const std::vector<std::string> fractions(parts, kConstant);
  std::string text =
      "static inline N::Propagator N::Propagator_make(const N::Parameters* par, Real h,"
      "const N::State* z) {";
  if (parts > 0)
    text += fmt::format("const Real fractions[{}] = {{{}}};", parts, fmt::join(fractions, ", "));
  text += "N::Propagator self = {0};";
  for (const Beginning& each : propagator.beginnings) {
    if (each.field != "z")
      text += fmt::format("self.{} = {};", each.field, value_of(each, each.from));
  }
  if (parts > 0) {
    text +=
        fmt::format("for (int i = 0; i < {}; ++i) {{ self.lengths[i] = h * fractions[i];", parts);
    for (const Beginning& each : propagator.substep_beginnings)
      text += fmt::format("self.{}[i] = {};", each.field, value_of(each, "self.lengths[i]"));
    text += "}";
  }
  return {text + "N::Propagator_reset(&self, z); return self; }", propagator.fractions};
}

Pattern time_pattern(const std::optional<Place>& place) {
  std::string value = "(Real)(self->steps) * self->h";
  if (place) value = "self->z" + to_text(Place{"", place->field, place->indices});
  return {fmt::format(
      "static inline Real N::Propagator_time(const N::Propagator* self) {{ return {}; }}", value)};
}

}  // namespace

Pattern c_record_pattern(const Record& record) {
  std::string text = "typedef struct {";
  for (const Field& field : record.fields) {
    text += fmt::format("{} {}{};", type_of(field.type), field.name, sizes_of(field));
  }
  if (record.fields.empty()) text += "char none;";
  return {text + fmt::format("}} N::{};", record.name)};
}

Pattern c_defaults_pattern(const Record& parameters) {
  Pattern pattern;
  std::string values;
  for (const Field& field : parameters.fields) {
    std::string list;
    for (const Rational& value : field.values) {
      pattern.constants.push_back(value);
      list += (list.empty() ? "" : ", ") + std::string(kConstant);
    }
    values += (values.empty() ? "" : ", ") + (field.sizes.empty() ? list : "{" + list + "}");
  }
  pattern.text = fmt::format(
      "static inline N::Parameters N::default_parameters(void) {{ const N::Parameters par = {{{}}};"
      "return par; }}",
      values.empty() ? "0" : values);
  return pattern;
}

Pattern c_start_pattern(const Record& start) {
  std::string text = "static inline N::Start N::start(void) { N::Start start = {0};";
  for (const Field& field : start.fields) {
    if (field.type.starts_with("NewtonRule"))
      text += fmt::format("start.{} = hamgen::NewtonRule_of_power({});", field.name,
                          field.type.at(field.type.find('<') + 1));
  }
  return {text + "return start; }"};
}

Pattern c_step_pattern() {
  return {
      "static inline hamgen::StepReport N::step(const N::Parameters* par, Real h, N::State* z) {"
      "N::Propagator self = N::Propagator_make(par, h, z);"
      "const hamgen::StepReport report = N::Propagator_step(&self);"
      "if (report.converged) *z = self.z; return report; }"};
}

std::vector<ShellPart> c_propagator_parts(const Propagator& propagator) {
  std::vector<ShellPart> parts = {c_record_pattern(propagator.record)};
  parts.insert(parts.end(), propagator.routines.begin(), propagator.routines.end());
  parts.emplace_back(make_pattern(propagator));
  for (const Accessor& accessor : propagator.accessors) {
    if (accessor.name == "time") parts.emplace_back(time_pattern(accessor.place));
  }
  return parts;
}

}  // namespace hamgen
