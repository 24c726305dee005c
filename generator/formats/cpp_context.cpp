#include "generator/formats/cpp_context.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

std::vector<CppGroup> group(const std::vector<Quantity>& quantities) {
  std::vector<CppGroup> groups;
  std::set<std::string> taken;
  std::string last;
  for (const Quantity& quantity : quantities) {
    const ElementName element = split_element(quantity.name);
    if (groups.empty() || !element.indexed || last != element.base) {
      std::string name = member_identifier(element.base);
      while (!taken.insert(name).second) name += "_";
      groups.push_back({name, element.indexed, {}});
      last = element.indexed ? element.base : "";
    }
    groups.back().elements.push_back(&quantity);
  }
  return groups;
}

// "q" or "q[2]" as a member of a struct: field name per quantity, in order.
std::vector<std::string> fields(const std::vector<CppGroup>& groups) {
  std::vector<std::string> result;
  for (const CppGroup& g : groups) {
    for (std::size_t i = 0; i < g.elements.size(); ++i) {
      result.push_back(g.is_array ? fmt::format("{}[{}]", g.name, i) : g.name);
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
      mechanics(equations.mechanics) {
  // A large system's state is two arrays, whatever the model calls their parts.
  for (int i = 0; i < 2 * n(); ++i) {
    variables.push_back(mechanics.variables[static_cast<std::size_t>(i)]);
    if (!arrays()) continue;
    variables.back() = {fmt::format("{}[{}]", i < n() ? "q" : "p", i % n()), "", "", 0};
  }
  parameters = mechanics.parameters;
  if (uses_energy_parameter(equations)) {
    parameters.push_back({"E0", "", "energy of the initial state: set it before use", 0});
  }
  parameter_groups = group(parameters);
  state_groups = group(variables);
  state_fields = fields(state_groups);
  parameter_fields = fields(parameter_groups);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    parameter_text[parameters[i].name] = "par." + parameter_fields[i];
  }
}

CppExpression CppContext::expression(Names& names) {
  return CppExpression(
      scalar,
      [this, &names](const std::string& symbol) -> std::string {
        if (symbol == "pi") {
          uses_pi = true;
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
  functions.insert(cpp.functions().begin(), cpp.functions().end());
}

void CppContext::load_state(CodeWriter& out, Names& names, const std::set<std::string>& used,
                            StateForm form) const {
  for (int i = 0; i < 2 * n(); ++i) {
    const std::string& name = variable_name(i);
    if (!used.contains(name)) continue;
    const std::string value =
        form == StateForm::fields ? "z." + state_field(i) : fmt::format("z[{}]", i);
    out.line(fmt::format("const Real {} = {};", names.local(name), value));
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

std::set<std::string> used_symbols(const std::vector<Statement>& statements) {
  std::set<std::string> used;
  for (const Statement& s : statements) collect_symbols(s.value, used);
  return used;
}

}  // namespace hamgen
