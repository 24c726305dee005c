#include "generator/formats/cpp_interface.hpp"

#include <fmt/format.h>

#include "generator/base/quoted_text.hpp"
#include "generator/formats/numerics.hpp"

namespace hamgen {

namespace {

using Lines = std::vector<std::string>;

// A function that shows `each` number and its place in the host's arrays; what it is given, types
// and names, has no names where nothing is shown.
void write_walk(CodeWriter& out, const std::string& name,
                std::vector<std::pair<std::string, std::string>> arguments, const Lines& lines) {
  const bool record = arguments.front().first == "Record&";
  arguments.emplace_back("const Each&", "each");
  Lines list;
  for (const auto& [type, argument] : arguments)
    list.push_back(type + (lines.empty() ? "" : " " + argument));
  out.line(record ? "template <class Record, class Each>" : "template <class Each>");
  const std::string head = fmt::format("void {}({})", name, joined_texts(list, ", "));
  if (lines.empty()) return out.line(head + " {}\n");
  out.open(head);
  for (const std::string& line : lines) out.line(line);
  out.close();
  out.line();
}

Lines parameter_places(const EmitContext& context) {
  Lines lines;
  for (std::size_t i = 0; i < context.parameter_fields.size(); ++i)
    lines.push_back(fmt::format("each({}, par.{});", i, context.parameter_fields[i]));
  return lines;
}

Lines state_places(const EmitContext& context) {
  const auto both = [](const auto& place, const std::string& field) {
    return fmt::format("each({0}, z.{1}, beside.{1});", place, field);
  };
  if (context.arrays()) {
    return {"for (int i = 0; i < n; ++i) {", "  " + both("i", "q[i]"), "  " + both("n + i", "p[i]"),
            "}"};
  }
  Lines lines;
  for (int i = 0; i < 2 * context.n(); ++i) lines.push_back(both(i, context.state_field(i)));
  return lines;
}

// The `count` values that a call leaves in the array, from the place `first` on.
void add_values(Lines& lines, const std::string& array, std::size_t count, std::size_t first,
                const std::string& call) {
  if (count == 0) return;
  const std::string place = first == 0 ? "i" : fmt::format("{} + i", first);
  lines.push_back(fmt::format("Real {}[{}];", array, count));
  lines.push_back(call);
  lines.push_back(
      fmt::format("for (int i = 0; i < {}; ++i) each({}, {}[i]);", count, place, array));
}

// Elements of one array that follow each other are one entry.
void write_quantity_list(CodeWriter& out, const std::string& name, const QuantityList& quantities) {
  out.line(fmt::format("const hamgen_quantity {}[] = {{", name));
  for (const QuantityList::Run& run : quantities.runs()) {
    out.line(fmt::format("    {{{}, {}, {}, {}, {}, {}}},", cpp_string(run.of.name),
                         cpp_string(run.of.unit), cpp_string(run.of.comment), run.indexed ? 1 : 0,
                         run.first, run.count));
  }
  out.line("    {}};");
  out.line();
}

class InterfaceWriter {
 public:
  InterfaceWriter(CodeWriter& out, const EmitContext& context)
      : out_(out),
        context_(context),
        program_(context.program),
        method_(context.options.spaces.of_method()),
        modified_(program_.facts.modified_powers.size()),
        invariants_(program_.facts.invariants.size() - modified_) {}

  void write() {
    out_.line();
    out_.line("// The interface of plugin.h.");
    out_.open("struct hamgen_run");
    out_.line(method_ + "::Propagator propagator;");
    out_.line(context_.options.spaces.system + "::Real start_time = 0;  // of the propagator");
    out_.close(";");
    out_.line();
    out_.line(fmt::format("namespace {} {{", method_));
    out_.line("namespace {");
    out_.line();
    write_facts();
    out_.lines(cpp_numerics("shells/plugin_run"));
    out_.line();
    if (context_.options.tangent) {
      out_.lines(cpp_numerics("shells/plugin_tangent"));
      out_.line();
    }
    write_quantity_list(out_, "variable_list", program_.environment.variables);
    write_quantity_list(out_, "parameter_list", names_of(program_.environment.parameters));
    write_quantity_list(out_, "invariant_list", names_of(program_.facts.invariants));
    write_table();
    out_.line("}  // namespace");
    out_.line(fmt::format("}}  // namespace {}", method_));
    out_.line();
    out_.open("extern \"C\" const hamgen_plugin* hamgen_plugin_entry()");
    out_.line(fmt::format("return hamgen_arithmetic_is_ieee() ? &{}::plugin : nullptr;", method_));
    out_.close();
  }

 private:
  // What the functions that are the same in every plugin ask of the system and its method.
  void write_facts() {
    const auto size = static_cast<std::size_t>(2 * context_.n());
    Lines values;
    add_values(values, "result", invariants_, 0, "invariants(par, z, result);");
    if (modified_ > 0) {
      const std::string step = literal(context_.options.watched_step, context_.scalar);
      add_values(values, "modified", modified_, invariants_,
                 fmt::format("modified_energies(par, {}, z, modified);", step));
    }
    Lines gradient;
    add_values(gradient, "result", size, 0, "gradient(par, z, result);");
    const std::pair<std::string, std::string> par{"const Parameters&", "par"};
    const std::pair<std::string, std::string> z{"const State&", "z"};
    write_walk(out_, "for_parameters", {{"Record&", "par"}}, parameter_places(context_));
    write_walk(out_, "for_state", {{"Record&", "z"}, {"const State&", "beside"}},
               state_places(context_));
    write_walk(out_, "for_invariants", {par, z}, values);
    write_walk(out_, "for_gradient", {par, z}, gradient);
    out_.line(program_.has_carry()
                  ? "const State& carry_of(const Propagator& run) { return run.carry(); }"
                  : "State carry_of(const Propagator&) { return State(); }  // sums are plain");
    out_.line(fmt::format("constexpr bool never_fails = {};  // a step", program_.unchecked));
    if (context_.options.tangent) out_.line(fmt::format("constexpr int variables = {};", size));
    out_.line();
  }

  // In the order of struct hamgen_plugin.
  void write_table() {
    out_.line(fmt::format(
        "const hamgen_plugin plugin = {{HAMGEN_PLUGIN_VERSION, {}, {}, {}, {}, {}, "
        "{}, create, destroy, advance, get_state, get_carry, energy_of, invariants_of, "
        "gradient_of, {}, save_run, restore_run, variable_list, parameter_list, "
        "invariant_list, default_parameters, get_time, get_h, get_parameters, set_state, "
        "set_h, set_parameters}};",
        context_.n(), program_.environment.parameters.size(), invariants_ + modified_,
        context_.scalar.digits,
        cpp_string(fmt::format("{}, {}", program_.facts.system, program_.facts.scheme)),
        cpp_string(program_.facts.solver), context_.options.tangent ? "tangent_of" : "nullptr"));
    out_.line();
  }

  CodeWriter& out_;
  const EmitContext& context_;
  const Program& program_;
  std::string method_;
  std::size_t modified_, invariants_;
};

}  // namespace

void write_interface(CodeWriter& out, const EmitContext& context) {
  InterfaceWriter(out, context).write();
}

}  // namespace hamgen
