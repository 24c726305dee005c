#include "generator/readback/read_back.hpp"

#include <fmt/format.h>

#include <algorithm>

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

constexpr std::string_view kPluginGuard = "#ifndef HAMGEN_PLUGIN_H";

TextKind kind_of(std::span<const CppToken> tokens) {
  if (tokens[0].text == kPluginGuard) return TextKind::plugin;
  return family_of(tokens) != nullptr ? TextKind::c_header : TextKind::header;
}

// What the guard of a section says of its name.
std::string guarded(std::span<const CppToken> tokens, const std::string& begin) {
  const auto found = std::ranges::find_if(tokens, [&](const CppToken& token) {
    return token.kind == CppToken::Kind::directive && token.text.starts_with(begin);
  });
  return found == tokens.end() ? "" : found->text.substr(begin.size());
}

// What the program has of such a file: whether it has a tangent map is free, and where the method
// has no namespace of its own its parameters are the system's.
Contents contents_of_file(const Program& program, std::span<const CppToken> tokens, int lanes) {
  bool tangent = false;
  for (std::size_t i = 1; i < tokens.size(); ++i)
    tangent = tangent || (tokens[i].is("tangent") && tokens[i - 1].is("bool"));
  const std::string system = guarded(tokens, "#ifndef HAMGEN_SYSTEM_");
  return contents_of(program, {.own_space = system != guarded(tokens, "#ifndef HAMGEN_METHOD_"),
                               .tangent = tangent && program.routine("tangent") != nullptr,
                               .lanes = lanes});
}

// A header or a plugin.
class FileReader {
 public:
  FileReader(const EmittedFile& file, const Program& program, std::span<const CppToken> tokens,
             ReadBack& found)
      : file_(file),
        program_(program),
        precision_(precision_of(file.scalar)),
        n_(program.environment.arrays ? program.environment.degrees_of_freedom : 0),
        contents_(contents_of_file(program, tokens, file.lanes)),
        found_(found),
        cursor_(tokens) {}

  void run() {
    const bool plugin = found_.kind == TextKind::plugin;
    if (plugin) {
      expect(std::string(plugin_header()), "plugin.h");
      expect(std::string(tested_text("shells/plugin_memory")), "numerics/shells/plugin_memory.hpp");
    } else {
      expect_directive(cursor_, "#pragma once");
    }
    const std::vector<std::string> included = read_includes(cursor_, precision_);
    expect_ieee_begin(cursor_, precision_);
    if (in_lanes())
      add_blocks(read_lane_blocks(cursor_, file_.text, precision_, file_.lanes), digest_);
    read_section("system", contents_.system);
    for (const std::string& name : included) add_blocks(read_support(name), digest_);
    if (!in_lanes()) add_blocks(read_blocks(cursor_, file_.text, precision_), digest_);
    if (has_packs()) {
      const FixedBlocks packs = read_packs(cursor_, file_.text, precision_);
      packs_digest_ = packs.digest;
      found_.blocks += static_cast<int>(packs.names.size());
    }
    read_section("method", contents_.method);
    expect_ieee_end(cursor_, precision_);
    if (plugin) read_interface();
    if (!cursor_.at_end()) throw TextDifference(cursor_.line(), "something behind the end");
  }

 private:
  // Of many trajectories: all that the file has is of packs.
  [[nodiscard]] bool in_lanes() const { return file_.lanes > 0; }
  // Of one, whose stages are computed side by side.
  [[nodiscard]] bool has_packs() const { return program_.stages && program_.stages->packs() > 0; }
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
    expect_ieee_end(cursor, precision_);
    if (!cursor.at_end()) throw TextDifference(1, "something behind the end of " + name);
    return blocks;
  }

  void read_interface() {
    const InterfaceFacts facts{.program = program_,
                               .precision = precision_,
                               .system = system_,
                               .space = method_,
                               .tangent = has_tangent(),
                               .watched_step = file_.watched_step};
    for (const InterfacePiece& piece : plugin_interface(facts))
      expect_pattern(cursor_, piece.pattern, precision_, piece.name);
    const Environment& environment = program_.environment;
    found_.places = static_cast<int>(environment.parameters.size() + environment.variables.size());
  }
  [[nodiscard]] bool has_tangent() const {
    return std::ranges::any_of(contents_.method, [](const Piece& piece) {
      const auto* const routine = std::get_if<Routine>(&piece);
      return routine != nullptr && routine->name == "tangent";
    });
  }

  // #ifndef macro, namespaces, what stands in them, #endif.
  void read_section(const std::string& kind, const std::vector<Piece>& pieces) {
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
    const std::string digest = define.text.substr(defines.size());
    cursor_.expect("namespace");
    const int line = cursor_.line();
    std::string name = cursor_.word();
    std::string flat = name;
    while (cursor_.accept("::")) {
      const std::string part = cursor_.word();
      name += "::" + part;
      flat += "_" + part;
    }
    if (macro != begin.substr(8) + flat)
      throw TextDifference(line, fmt::format("{} guards the namespace {}", macro, name));
    (kind == "system" ? system_ : method_) = name;
    const bool inside = name == system_ || name.starts_with(system_ + "::");
    if (!inside) throw TextDifference(line, fmt::format("{} is not in {}", name, system_));
    expect(fmt::format("{{ inline namespace emitted_{} {{", digest), "a section");
    const bool packs = kind == "method" && has_packs();
    const bool in_registers = packs || in_lanes();
    if (in_registers) expect("inline namespace HAMGEN_REGISTERS {", "a section");
    kind == "system" && !in_lanes() ? read_type() : read_names();
    read_constants(kind);
    if (packs) expect(fmt::format("using Lanes = Pack<{}>;", program_.stages->lanes), "Lanes");
    for (const Piece& piece : pieces) std::visit([this](const auto& each) { read(each); }, piece);
    expect(in_registers ? "} } }" : "} }", "a section");
    expect_directive(cursor_, fmt::format("#elif {} != 0x{}", macro, digest));
    expect_directive(cursor_,
                     fmt::format("#error \"another {} of this name is included before: generate "
                                 "one with --namespace\"",
                                 kind));
    expect_directive(cursor_, "#endif");
  }

  void read_type() {
    expect(precision_.is_quad() ? "__extension__ typedef __float128 Real;"
                                : fmt::format("using Real = {};", precision_.type),
           "Real");
  }
  void read_names() {
    if (!cursor_.peek().is("namespace")) return;
    const std::string space =
        in_lanes() ? fmt::format("lanes_{}", file_.lanes) : std::string(precision_.space);
    expect(fmt::format("namespace numerics = ::hamgen_{}::{}; using", digest_, space),
           "the names of the fixed blocks");
    read_block_names(cursor_, "numerics", in_lanes() ? lane_blocks() : cpp_blocks());
    if (!has_packs()) return;
    expect(fmt::format("namespace packs = ::hamgen_{}::packs; using", packs_digest_),
           "the names of packs");
    read_block_names(cursor_, "packs", pack_blocks());
  }
  void read_constants(const std::string& kind) {
    if (cursor_.peek(3).is("pi")) {
      expect({fmt::format("inline constexpr {} pi = {};", in_lanes() ? precision_.type : "Real",
                          kConstant),
              {*parse_decimal("3.14159265358979323846264338327950288419716939937510582")}},
             "pi");
    }
    if (kind == "system" && n_ > 0) expect(fmt::format("inline constexpr int n = {};", n_), "n");
  }

  void read(const Record& record) { expect(record_pattern(record, system_), record.name); }
  void read(const ArrayMatrix& matrix) { expect(matrix_pattern(matrix), "Matrix"); }
  void read(const Propagator& propagator) {
    for (const ShellPart& part : propagator_parts(propagator, in_lanes())) {
      if (const auto* pattern = std::get_if<Pattern>(&part)) expect(*pattern, "Propagator");
      if (const auto* routine = std::get_if<Routine>(&part)) read(*routine, &propagator.record);
    }
  }
  void read(const StepOfPropagator&) { expect(step_pattern(in_lanes()), "step"); }
  void read(const Watch& watch) {
    expect(watch_pattern(watch, program_.environment), "WatchedPropagator");
  }
  // `run`: what a run keeps, of a routine that is given it.
  void read(const Routine& routine, const Record* run = nullptr) {
    const int line = cursor_.line();
    const CppFunction function = read_function(cursor_, run != nullptr);
    if (function.name != routine.name)
      throw TextDifference(line, fmt::format("'{}' where {} belongs", function.name, routine.name));
    RoutineReader(function, routine,
                  {.precision = precision_, .n = n_, .lanes = in_lanes(), .run = run})
        .compare();
    ++found_.routines;
    found_.instructions += instructions_of(routine.body);
  }

  void expect(const Pattern& pattern, const std::string& what) {
    expect_pattern(cursor_, pattern, precision_, what);
  }
  void expect(const std::string& text, const std::string& what) {
    expect_pattern(cursor_, {text}, precision_, what);
  }

  const EmittedFile& file_;
  const Program& program_;
  const Precision& precision_;
  int n_;
  Contents contents_;
  ReadBack& found_;
  TokenCursor cursor_;
  std::string system_, method_;  // namespaces
  std::string digest_, packs_digest_;
};

}  // namespace

ReadBack read_back(const EmittedFile& file, const Program& program) {
  ReadBack found;
  try {
    const std::vector<CppToken> tokens = tokens_of(file.text);
    found.kind = kind_of(tokens);
    if (found.kind == TextKind::c_header) {
      read_c_file(tokens, precision_of(file.scalar), program, found);
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
