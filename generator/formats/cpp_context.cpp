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
  for (std::size_t i = 0; i < environment.parameters.size(); ++i) {
    parameter_text[environment.parameters[i].name] = "par." + parameter_fields[i];
  }
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

CppExpression CppContext::expression(Names& names) {
  return CppExpression(
      scalar,
      [this, &names](const std::string& symbol) -> std::string {
        if (symbol == "pi") {
          used.pi = true;
          return "pi";
        }
        if (symbol == "h") return "h";
        if (const auto it = parameter_text.find(symbol); it != parameter_text.end())
          return it->second;
        return names.local(symbol);
      },
      options.builtins);
}

void CppContext::note(const CppExpression& cpp) {
  used.functions.insert(cpp.functions().begin(), cpp.functions().end());
}

void CppContext::load_state(CodeWriter& out, Names& names,
                            const std::set<std::string>& symbols) const {
  for (int i = 0; i < 2 * n(); ++i) {
    const std::string& name = variable_name(i);
    if (!symbols.contains(name)) continue;
    out.line(fmt::format("const Real {} = z.{};", names.local(name), state_field(i)));
  }
}

void write_statements(CodeWriter& out, const CppExpression& cpp, Names& names,
                      const std::vector<Statement>& statements,
                      const std::set<std::string>& declared) {
  for (const Statement& s : statements) {
    const std::string value = cpp(s.value);
    const std::string& name = names.local(s.name);
    out.line(
        fmt::format("{}{} = {};", declared.contains(s.name) ? "" : "const Real ", name, value));
  }
}

}  // namespace hamgen
