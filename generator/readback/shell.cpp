#include "generator/readback/shell.hpp"

#include <fmt/format.h>

#include "generator/program/written_code.hpp"

namespace hamgen {

namespace {

// z_.t, or h_.
std::string kept_text(const Place& place) {
  if (place.object == "self") return place.field + "_";
  return place.object.substr(5) + "_" + to_text(Place{"", place.field, place.indices});
}

// How a number is handed on.
std::string given_number(bool lanes) { return lanes ? "const Real&" : "Real"; }

std::string constructor_text(const Propagator& propagator, bool lanes) {
  const auto made = [](const Beginning& each, const std::string& from) {
    return each.routine.empty() ? from : fmt::format("{}(par, {})", each.routine, from);
  };
  std::string text =
      fmt::format("Propagator(const Parameters& par, {} h, const State& z)", given_number(lanes));
  const char* separator = " : ";
  for (const Beginning& each : propagator.beginnings) {
    text += fmt::format("{}{}_({})", separator, each.field, made(each, each.from));
    separator = ", ";
  }
  if (propagator.fractions.empty()) return text + "{}";
  const std::vector<std::string> fractions(propagator.fractions.size(), kConstant);
  text += fmt::format("{{ constexpr {} fractions[substeps] = {{{}}};", lanes ? "double" : "Real",
                      fmt::join(fractions, ", "));
  text += "for (int i = 0; i < substeps; ++i) { lengths_[i] = h * fractions[i];";
  for (const Beginning& each : propagator.substep_beginnings)
    text += fmt::format("{}_[i] = {};", each.field, made(each, each.from + "_[i]"));
  return text + "} }";
}

std::string member_text(const Record& record) {
  std::string text;
  for (const Field& field : record.fields) {
    if (field.name == "rest") {  // beside dz
      text.back() = ',';
      text += "rest_;";
      continue;
    }
    const std::string size = field.sizes.empty() ? "" : "[substeps]";
    const char* value = field.name == "steps"     ? " = 0"
                        : field.name == "lengths" ? " = {}"
                        : field.name == "running" ? " = true"
                                                  : "";
    text += fmt::format("{} {}_{}{};", field.type, field.name, size, value);
  }
  return text;
}

}  // namespace

Pattern record_pattern(const Record& record, const std::string& system) {
  const std::string base = record.extends ? fmt::format(" : ::{}::{}", system, record.name) : "";
  Pattern pattern{fmt::format("struct {}{} {{", record.name, base)};
  for (const Field& field : record.fields) {
    std::string sizes;
    for (const int size : field.sizes) sizes += fmt::format("[{}]", size);
    std::string values;
    for (const Rational& value : field.values) {
      const bool number = field.type != "int" && field.type != "bool" && field.type != "Mask";
      if (number) pattern.constants.push_back(value);
      values += (values.empty() ? "" : ", ") + (number                ? std::string(kConstant)
                                                : field.type == "int" ? value.get_str()
                                                : value == 0          ? "false"
                                                                      : "true");
    }
    if (!field.sizes.empty()) {
      values = "{" + values + "}";
    } else if (values.empty() && field.type == "Real") {
      values = kConstant;
      pattern.constants.emplace_back(0);
    }
    pattern.text += fmt::format("{} {}{}{}{};", field.type, field.name, sizes,
                                values.empty() ? "" : " = ", values);
  }
  pattern.text += "};";
  return pattern;
}

std::vector<ShellPart> propagator_parts(const Propagator& propagator, bool lanes) {
  const bool composed = !propagator.fractions.empty();
  std::string begin = "class Propagator { public: ";
  for (const auto& [name, value] : propagator.constants)
    begin += fmt::format("static constexpr int {} = {};", name, value);
  std::vector<ShellPart> parts = {
      Pattern{begin + constructor_text(propagator, lanes), propagator.fractions}};
  for (const Routine& routine : propagator.routines) {
    if (routine.name != "substep") parts.emplace_back(routine);
  }
  std::string accessors;
  for (const Accessor& accessor : propagator.accessors) {
    const std::string value = accessor.place ? kept_text(*accessor.place)
                              : lanes        ? "steps_ * h_"
                                             : "static_cast<Real>(steps_) * h_";
    const std::string type = accessor.type != "Real" ? "const " + accessor.type + "&"
                             : accessor.place        ? given_number(lanes)
                                                     : "Real";
    accessors +=
        fmt::format("[[nodiscard]] {} {}() const {{ return {}; }}", type, accessor.name, value);
  }
  parts.emplace_back(Pattern{accessors + "private: "});
  if (composed) parts.emplace_back(propagator.routines.front());
  parts.emplace_back(Pattern{member_text(propagator.record) + "};"});
  return parts;
}

Pattern step_pattern(bool lanes) {
  return {
      fmt::format("[[nodiscard]] inline StepReport step(const Parameters& par, {} h, State& z) {{"
                  "Propagator propagator(par, h, z); const StepReport report = propagator.step();"
                  "{} z = propagator.state(); return report; }}",
                  given_number(lanes), lanes ? "" : "if (report.converged)")};
}

Pattern matrix_pattern(const ArrayMatrix& matrix) {
  return {fmt::format("using Matrix = {};", written::type_of(matrix))};
}

}  // namespace hamgen
