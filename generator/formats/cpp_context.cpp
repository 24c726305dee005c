#include "generator/formats/cpp_context.hpp"

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

}  // namespace

CppContext::CppContext(const Program& the_program, const CppOptions& the_options)
    : program(the_program),
      options(the_options),
      scalar(find_scalar(the_options.scalar)),
      equations(program.plan.equations),
      mechanics(equations.mechanics),
      environment(environment_of(equations, arrays())),
      code(step_code(program)),
      parameter_fields(texts(environment.parameter_layout)),
      state_fields(texts(environment.state_layout)) {
  for (const char* name : {"prepare", "solve"}) needed_.merge(callees(code, name));
  if (options.tangent) needed_.merge(callees(code, "tangent"));
}

void CppContext::write_routine(CodeWriter& out, std::string_view name) {
  const Routine* routine = code.routine(name);
  if (routine == nullptr || !written_.emplace(name).second) return;
  print(out, *routine, {scalar, options.builtins, arrays() ? n() : 0}, used);
}

void CppContext::write_with_callees(CodeWriter& out, std::string_view name) {
  const std::set<std::string> wanted = callees(code, std::string(name));
  for (const Routine& routine : code.routines) {
    if (wanted.contains(routine.name)) write_routine(out, routine.name);
  }
}

}  // namespace hamgen
