#include "generator/readback/read_back.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "generator/base/numerics_text.hpp"
#include "generator/readback/c_file.hpp"
#include "generator/readback/event_shell.hpp"
#include "generator/readback/findings.hpp"
#include "generator/readback/fixed_text.hpp"
#include "generator/readback/plugin_interface.hpp"
#include "generator/readback/routine_reader.hpp"
#include "generator/readback/shell.hpp"

namespace hamgen {

namespace {

// A section of the file: #ifndef macro, namespaces, what stands in them, #endif.
struct Section {
  std::string kind;  // "system"
  std::string name;  // of its namespace: "pendulum"
  std::string digest;
};

std::string time_field(const Program& program) {
  if (!program.facts.has_time) return {};
  const auto last = static_cast<std::size_t>(program.environment.degrees_of_freedom - 1);
  return to_text(program.environment.state_layout.places[last]).substr(1);
}

constexpr std::string_view kPluginGuard = "#ifndef HAMGEN_PLUGIN_H";

TextKind kind_of(std::span<const CppToken> tokens) {
  if (tokens[0].text == kPluginGuard) return TextKind::plugin;
  const bool in_c = tokens.size() > 1 && tokens[1].text == "#include <math.h>";
  return in_c ? TextKind::c_header : TextKind::header;
}

std::vector<InterfaceQuantity> names_of(const std::vector<Quantity>& quantities) {
  std::vector<InterfaceQuantity> names;
  for (const Quantity& each : quantities) names.push_back({each.name, each.unit, each.comment});
  return names;
}

// "q", "q[2]": places in a record.
std::vector<std::string> place_texts(const std::vector<Place>& places) {
  std::vector<std::string> texts;
  for (const Place& place : places) texts.push_back(to_text(place).substr(1));
  return texts;
}

ShellFacts facts_of(const Program& program) {
  return {program, program.environment.arrays, time_field(program),
          static_cast<int>(program.facts.modified_powers.size()),
          place_texts(program.environment.state_layout.places)};
}

// A header or a plugin.
class FileReader {
 public:
  FileReader(const EmittedFile& file, const Program& program, std::span<const CppToken> tokens,
             ReadBack& found)
      : file_(file),
        program_(program),
        precision_(precision_of(file.scalar)),
        facts_(facts_of(program)),
        n_(facts_.arrays ? program.environment.degrees_of_freedom : 0),
        found_(found),
        cursor_(tokens) {}

  void run() {
    const bool plugin = found_.kind == TextKind::plugin;
    if (plugin) {
      expect(std::string(plugin_header()), "plugin.h");
      expect_directive(cursor_, "#include <new>");
    } else {
      expect_directive(cursor_, "#pragma once");
    }
    const std::vector<std::string> included = read_includes(cursor_, precision_);
    expect_ieee_begin(cursor_, precision_);
    read_section("system");
    std::string digest;
    for (const std::string& name : included) add_blocks(read_support(name), digest);
    add_blocks(read_blocks(cursor_, file_.text, precision_), digest);
    if (!digest.empty()) digest_ = digest;
    read_section("method");
    expect_ieee_end(cursor_);
    if (plugin) read_interface();
    if (!cursor_.at_end()) throw TextDifference(cursor_.line(), "something behind the end");
    require_all();
  }

 private:
  void add_blocks(const FixedBlocks& blocks, std::string& digest) {
    if (blocks.digest.empty()) return;
    if (!digest.empty() && digest != blocks.digest)
      throw TextDifference(cursor_.line(), "fixed blocks of two versions");
    digest = blocks.digest;
    found_.blocks += static_cast<int>(blocks.names.size());
  }

  // --support shared: the fixed blocks in a file beside.
  FixedBlocks read_support(const std::string& name) {
    const auto found = file_.beside.find(name);
    if (found == file_.beside.end() || !name.starts_with("hamgen_support"))
      throw TextNotUnderstood(1, fmt::format("{}, which is included and not there", name));
    const std::string& text = found->second;
    const std::vector<CppToken> tokens = tokens_of(text);
    TokenCursor cursor(tokens);
    expect_directive(cursor, "#pragma once");
    if (!read_includes(cursor, precision_).empty())
      throw TextDifference(1, name + " includes another file");
    expect_ieee_begin(cursor, precision_);
    FixedBlocks blocks = read_blocks(cursor, text, precision_);
    expect_ieee_end(cursor);
    if (!cursor.at_end()) throw TextDifference(1, "something behind the end of " + name);
    return blocks;
  }

  void read_interface() {
    const StepFacts& said = program_.facts;
    const Environment& environment = program_.environment;
    const InterfaceFacts facts{
        .shell = facts_,
        .precision = precision_,
        .system = system_,
        .space = method_,
        .degrees_of_freedom = environment.degrees_of_freedom,
        .parameters = place_texts(environment.parameter_layout.places),
        .state = facts_.state,
        .invariants = static_cast<int>(said.invariants.size() - said.modified_powers.size()),
        .named = {names_of(environment.variables), names_of(environment.parameters),
                  names_of(said.invariants)},
        .tangent = seen_.contains("tangent"),
        .watched_step = file_.watched_step,
        .description = fmt::format("{}, {}", said.system, said.scheme),
        .solver = said.solver};
    for (const InterfacePiece& piece : plugin_interface(facts))
      expect_pattern(cursor_, piece.pattern, precision_, piece.name);
    found_.places = static_cast<int>(facts.parameters.size() + facts.state.size());
  }

  void read_section(const std::string& kind) {
    Section section{.kind = kind, .name = {}, .digest = {}};
    const CppToken& guard = cursor_.take();
    const std::string begin =
        fmt::format("#ifndef HAMGEN_{}_", kind == "system" ? "SYSTEM" : "METHOD");
    if (guard.kind != CppToken::Kind::directive || !guard.text.starts_with(begin))
      throw TextDifference(guard.line, fmt::format("'{}' where the {} begins", guard.text, kind));
    const std::string macro = guard.text.substr(std::string("#ifndef ").size());
    const CppToken& define = cursor_.take();
    const std::string defines = fmt::format("#define {} 0x", macro);
    if (define.kind != CppToken::Kind::directive || !define.text.starts_with(defines))
      throw TextDifference(define.line, fmt::format("'{}' is not '{}...'", define.text, defines));
    section.digest = define.text.substr(defines.size());
    cursor_.expect("namespace");
    const int line = cursor_.line();
    section.name = cursor_.word();
    std::string flat = section.name;
    while (cursor_.accept("::")) {
      const std::string part = cursor_.word();
      section.name += "::" + part;
      flat += "_" + part;
    }
    if (macro != begin.substr(8) + flat)
      throw TextDifference(line, fmt::format("{} guards the namespace {}", macro, section.name));
    (kind == "system" ? system_ : method_) = section.name;
    const bool inside = section.name == system_ || section.name.starts_with(system_ + "::");
    if (!inside) throw TextDifference(line, fmt::format("{} is not in {}", section.name, system_));
    expect(fmt::format("{{ inline namespace emitted_{} {{", section.digest), "a section");
    while (!cursor_.peek().is("}")) read_item(section);
    expect("} }", "a section");
    expect_directive(cursor_, fmt::format("#elif {} != 0x{}", macro, section.digest));
    expect_directive(cursor_,
                     fmt::format("#error \"another {} of this name is included before: generate "
                                 "one with --namespace\"",
                                 kind));
    expect_directive(cursor_, "#endif");
  }

  void read_item(const Section& section) {
    const CppToken& first = cursor_.peek();
    if (first.is("struct")) return read_struct(section);
    if (first.is("class")) return read_class();
    if (first.is("enum") && has_events()) return once("Event", event_pattern(facts_));
    if (first.is("namespace")) {
      return expect(fmt::format("namespace numerics = ::hamgen_{}::{};", digest_, precision_.space),
                    "the name of the fixed blocks");
    }
    if (first.is("__extension__")) return once("Real", {"__extension__ typedef __float128 Real;"});
    if (first.is("using")) return read_using();
    if (first.is("inline") && cursor_.peek(1).is("constexpr")) return read_constant();
    read_routine();
  }

  [[nodiscard]] bool has_events() const { return !program_.events.empty(); }

  void read_class() { once("Propagator", propagator_pattern(facts_)); }

  void read_using() {
    if (cursor_.peek(1).is("Real"))
      return once("Real", {fmt::format("using Real = {};", precision_.type)});
    if (cursor_.peek(1).is("numerics")) {
      cursor_.take();
      return read_block_names(cursor_);
    }
    read_matrix();
  }

  void read_matrix() {
    if (!program_.matrix) throw TextDifference(cursor_.line(), "a matrix that the step has not");
    once("Matrix", matrix_pattern(*program_.matrix));
  }

  void read_constant() {
    if (cursor_.peek(3).is("n"))
      return once("n", {fmt::format("inline constexpr int n = {};", n_)});
    once("pi", {fmt::format("inline constexpr Real pi = {};", kConstant),
                {*parse_decimal("3.14159265358979323846264338327950288419716939937510582")}});
  }

  void read_struct(const Section& section) {
    const std::string name = cursor_.peek(1).text;
    const int line = cursor_.line();
    if (name == "Order") return read_matrix();
    if (name == "Watched" && has_events()) return once("Watched", watched_pattern(facts_));
    if (name == "Crossing" && has_events())
      return once("WatchedPropagator", watched_propagator_pattern());
    if (name == "Parameters") return read_parameters(section);
    if (name == "Folded") {
      const std::vector<Quantity>& constants = program_.facts.constants;
      return once_record(layout("Folded", constants, Defaults::values).record);
    }
    const Record* record = program_.record(name);
    if (record == nullptr) throw TextDifference(line, "a record that the step has not: " + name);
    once_record(*record);
  }

  void once_record(const Record& record) {
    Pattern pattern = record_pattern(record);
    pattern.text = "struct " + record.name + " " + pattern.text;
    once(record.name, pattern);
  }

  // Those of the method are added to those of the system: together they are the program's.
  void read_parameters(const Section& section) {
    const int line = cursor_.line();
    const bool of_method = cursor_.peek(2).is(":");
    expect(of_method ? fmt::format("struct Parameters : ::{}::Parameters {{", system_)
                     : "struct Parameters {",
           "the parameters");
    if (of_method != (section.kind == "method"))
      throw TextDifference(line, "parameters that are declared twice");
    for (const Field& field : program_.record("Parameters")->fields) {
      const bool here = cursor_.peek(1).is(field.name);
      if (!here) continue;
      Pattern pattern = record_pattern({.name = "", .fields = {field}});
      pattern.text = pattern.text.substr(1, pattern.text.size() - 3);  // without { };
      once("parameter " + field.name, pattern);
    }
    expect("};", "the parameters");
    seen_.insert("Parameters");
  }

  void read_routine() {
    const int line = cursor_.line();
    std::size_t ahead = 0;
    while (!cursor_.peek(ahead).is("(") && ahead < 12) ++ahead;
    const std::string name = ahead == 0 ? "" : cursor_.peek(ahead - 1).text;
    if (name == "step") return once("step", step_pattern(facts_));
    if (name == "modified_energy" && facts_.modified > 0)
      return once("modified_energy", modified_energy_pattern(facts_));
    const bool again = name == "gradient" && facts_.arrays && seen_.contains("gradient");
    if (again) return once("gradient of a state", gradient_pattern());
    const Routine* routine = program_.routine(name);
    if (routine == nullptr)
      throw TextDifference(line, fmt::format("'{}' is nothing that the step has", name));
    if (!seen_.insert(name).second) throw TextDifference(line, name + " is there twice");
    const CppFunction function = read_function(cursor_);
    RoutineReader reader(function, *routine, precision_, n_);
    reader.compare();
    ++found_.routines;
    found_.instructions += reader.instructions();
  }

  void once(const std::string& name, const Pattern& pattern) {
    const int line = cursor_.line();
    if (!seen_.insert(name).second && name != "pi")
      throw TextDifference(line, name + " is there twice");
    expect_pattern(cursor_, pattern, precision_, name);
  }

  void expect(const std::string& text, const std::string& what) {
    expect_pattern(cursor_, {text}, precision_, what);
  }

  void require_all() {
    std::set<std::string> wanted = {"Real", "Parameters", "State", "Propagator", "step"};
    for (const char* name : {"Coefficients", "Start"}) {
      if (program_.record(name) != nullptr) wanted.insert(name);
    }
    for (const char* name :
         {"energy", "gradient", "invariants", "events", "modified_energies", "prepare", "solve"})
      wanted.merge(callees(program_, name));
    if (has_events()) wanted.insert({"Event", "Watched", "WatchedPropagator"});
    if (seen_.contains("tangent")) wanted.merge(callees(program_, "tangent"));
    if (facts_.arrays) wanted.insert({"n", "gradient of a state"});
    if (facts_.modified > 0) wanted.insert("modified_energy");
    if (program_.matrix) wanted.insert("Matrix");
    for (const Field& field : program_.record("Parameters")->fields)
      wanted.insert("parameter " + field.name);
    for (const std::string& name : wanted) {
      if (!seen_.contains(name)) throw TextDifference(cursor_.line(), name + " is missing");
    }
  }

  const EmittedFile& file_;
  const Program& program_;
  const Precision& precision_;
  ShellFacts facts_;
  int n_;
  ReadBack& found_;
  TokenCursor cursor_;
  std::string system_, method_;  // namespaces
  std::string digest_;
  std::set<std::string> seen_;
};

}  // namespace

ReadBack read_back(const EmittedFile& file, const Program& program) {
  ReadBack found;
  try {
    const std::vector<CppToken> tokens = tokens_of(file.text);
    found.kind = kind_of(tokens);
    if (found.kind == TextKind::c_header) {
      read_c_file(tokens, precision_of(file.scalar), facts_of(program), found);
    } else {
      FileReader(file, program, tokens, found).run();
    }
    found.outcome = ReadBack::Outcome::same;
  } catch (const TextDifference& difference) {
    found.outcome = ReadBack::Outcome::different;
    found.line = difference.line;
    found.what = difference.what();
  } catch (const TextNotUnderstood& unknown) {
    found.outcome = ReadBack::Outcome::not_understood;
    found.line = unknown.line;
    found.what = unknown.what();
  }
  return found;
}

}  // namespace hamgen
