#include "generator/formats/emit_context.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

std::vector<std::string> texts(const Layout& layout) {
  std::vector<std::string> result;
  for (const Place& place : layout.places) {
    result.push_back(place.field);
    for (const AffineIndex& index : place.indices) {
      result.back() += fmt::format("[{}]", index.constant);
    }
  }
  return result;
}

// Adds the fields of `par` that a routine reads.
void collect_parameters(const Routine& routine, std::set<std::string>& fields) {
  std::set<std::string> symbols;
  collect_symbols(routine.body, symbols);
  for (const auto& [symbol, place] : routine.places) {
    if (place.object == "par" && symbols.contains(symbol)) fields.insert(place.field);
  }
}

}  // namespace

EmitContext::EmitContext(const Program& the_program, const EmitOptions& the_options,
                         const Dialect& the_dialect)
    : program(the_program),
      options(the_options),
      dialect(the_dialect),
      scalar(the_dialect.scalar),
      parameter_fields(texts(program.environment.parameter_layout)),
      state_fields(texts(program.environment.state_layout)) {
  for (const char* name : {"prepare", "solve"}) needed_.merge(callees(program, name));
  if (options.tangent) needed_.merge(callees(program, "tangent"));
  needed_.merge(callees(program, "events"));
  split_parameters();
}

void EmitContext::split_parameters() {
  std::set<std::string> of_system;
  std::set<std::string> of_method;
  for (const char* name : {"energy", "gradient", "invariants"}) {
    for (const std::string& called : callees(program, name)) {
      collect_parameters(*program.routine(called), of_system);
    }
  }
  for (const std::string& called : needed_) collect_parameters(*program.routine(called), of_method);
  system_parameters = *program.record("Parameters");
  method_parameters = {.name = "Parameters",
                       .fields = {},
                       .remark = {"Those of the system, and what the method takes besides."}};
  if (options.spaces.method.empty()) return;
  std::erase_if(system_parameters.fields, [&](const Field& field) {
    const bool ours = of_method.contains(field.name) && !of_system.contains(field.name);
    if (ours) method_parameters.fields.push_back(field);
    return ours;
  });
}

std::string sizes_text(const Field& field) {
  std::string text;
  for (const int size : field.sizes) text += fmt::format("[{}]", size);
  return text;
}

void EmitContext::write_routine(CodeWriter& out, std::string_view name) {
  const Routine* routine = program.routine(name);
  if (routine == nullptr || !written_.emplace(name).second) return;
  print(out, *routine, dialect, used);
}

void EmitContext::write_with_callees(CodeWriter& out, std::string_view name) {
  const std::set<std::string> wanted = callees(program, std::string(name));
  for (const Routine& routine : program.routines) {
    if (wanted.contains(routine.name)) write_routine(out, routine.name);
  }
}

}  // namespace hamgen
