#include "generator/readback/c_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "generator/base/fixed_blocks.hpp"
#include "generator/readback/c_function.hpp"
#include "generator/readback/c_names.hpp"
#include "generator/readback/c_shell.hpp"
#include "generator/readback/findings.hpp"
#include "generator/readback/fixed_text.hpp"
#include "generator/readback/routine_reader.hpp"

namespace hamgen {

namespace {

constexpr std::string_view kGuard = "#ifndef HAMGEN_C_";

// Ends with an underscore: "HAMGEN_C_FLOAT64_"
std::string guard_of_blocks(const Precision& precision) {
  std::string space(precision.space);
  std::ranges::transform(space, space.begin(), [](unsigned char c) { return std::toupper(c); });
  return "HAMGEN_C_" + space + "_";
}

// The tokens of a file in a language of this family, as they would be in C11.
std::vector<CppToken> in_c11(std::span<const CppToken> tokens, const CFamily& family,
                             const Precision& precision) {
  std::vector<CppToken> result;
  const auto replacements = family.replacements();
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const CppToken& token = tokens[i];
    const auto word =
        std::ranges::find_if(replacements, [&](const auto& pair) { return token.is(pair.second); });
    if (word != replacements.end()) {
      for (CppToken& each : tokens_of(word->first)) {
        if (each.kind == CppToken::Kind::end) break;
        result.push_back({each.kind, std::move(each.text), token.line});
      }
      continue;
    }
    result.push_back(token);
    const bool called = i + 1 < tokens.size() && tokens[i + 1].is("(");
    if (family.has_suffixes || !called) continue;
    const std::string_view suffix = suffix_of(precision);
    if (is_library_function(token.text)) {
      result.back().text += suffix;
    } else if (token.text.ends_with(suffix) &&
               is_library_function(
                   std::string_view(token.text).substr(0, token.text.size() - suffix.size()))) {
      throw TextDifference(token.line,
                           fmt::format("{}, which {} has not", token.text, family.language));
    }
  }
  return result;
}

class CFileReader {
 public:
  CFileReader(std::span<const CppToken> tokens, const CFamily& family, const Precision& precision,
              const Program& program, ReadBack& found)
      : family_(family),
        tokens_(tokens),
        cursor_(tokens),
        precision_(precision),
        code_(program),
        found_(found),
        names_{prefix("SYSTEM_"), prefix("METHOD_"), precision},
        contents_(contents_of(program, {.own_space = names_.system != names_.method})) {}

  void run() {
    expect_directive(cursor_, "#pragma once");
    for (const std::string_view line : family_.opening)
      expect_directive(cursor_, std::string(line));
    const bool inside =
        names_.method == names_.system || names_.method.starts_with(names_.system + "_");
    if (!inside)
      throw TextDifference(1, fmt::format("{} is not in {}", names_.method, names_.system));
    expect_ieee_begin(cursor_, precision_);
    while (cursor_.peek().kind == CppToken::Kind::directive &&
           cursor_.peek().text.starts_with(kGuard))
      read_section();
    expect_ieee_end(cursor_, precision_);
    if (!cursor_.at_end()) throw TextDifference(cursor_.line(), "something behind the end");
    for (const std::string& macro : {of_system(), of_method()}) {
      if (!seen_.contains(macro)) throw TextDifference(cursor_.line(), macro + " is missing");
    }
  }

 private:
  // What the guard of a section says that names begin with.
  std::string prefix(const std::string& kind) const {
    const std::string begin = std::string(kGuard) + kind;
    for (const CppToken& token : tokens_) {
      if (token.kind != CppToken::Kind::directive || !token.text.starts_with(begin)) continue;
      std::string name = token.text.substr(begin.size());
      const std::vector<CppToken> words = tokens_of(name);
      if (words.size() != 2 || words[0].kind != CppToken::Kind::word)
        throw TextDifference(token.line, fmt::format("'{}' begins no names", name));
      return name;
    }
    throw TextDifference(1, "no section that begins with " + begin);
  }

  void read_section() {
    const std::string macro = cursor_.peek().text.substr(std::string("#ifndef ").size());
    const int line = cursor_.take().line;
    once(macro, line);
    const CppToken& define = cursor_.take();
    const std::string defines = fmt::format("#define {} 0x", macro);
    if (define.kind != CppToken::Kind::directive || !define.text.starts_with(defines))
      throw TextDifference(define.line, fmt::format("'{}' is not '{}...'", define.text, defines));
    read_text(macro, line);
    const std::string digest = define.text.substr(defines.size());
    expect_directive(cursor_, fmt::format("#elif {} != 0x{}", macro, digest));
    expect_directive(cursor_,
                     "#error \"another text of this name is included before: generate one with "
                     "--namespace\"");
    expect_directive(cursor_, "#endif");
  }

  void read_text(const std::string& macro, int line) {
    const std::string blocks = guard_of_blocks(precision_);
    if (macro == of_system()) {
      read_pieces(contents_.system);
    } else if (macro == of_method()) {
      if (code_.unknowns > 0) read_tested("c/history");
      if (code_.record("Derivatives") != nullptr) read_tested("c/ahead");
      read_pieces(contents_.method);
    } else if (macro == "HAMGEN_C_" + names_.block("pi")) {
      expect({"static const Real hamgen::pi = " + std::string(kConstant) + ";",
              {*parse_decimal("3.14159265358979323846264338327950288419716939937510582")}},
             "pi");
    } else if (macro.starts_with(blocks)) {
      std::string name = macro.substr(blocks.size());
      std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
      if (std::ranges::find(c_blocks(), name, &FixedBlock::name) == c_blocks().end())
        throw TextDifference(line, macro + " guards no fixed block");
      read_block(name);
    } else {
      throw TextDifference(line, macro + " guards nothing that this header has");
    }
  }

  void read_block(const std::string& name) {
    if (name == kEpsilon) {
      expect({fmt::format("static const Real hamgen::epsilon = 0x1p-{}{};", precision_.bits - 1,
                          precision_.suffix)},
             "epsilon");
      return;
    }
    if (name == kVocabulary) {
      const char* suffix = precision_.bits == 24 ? "f" : precision_.bits == 64 ? "l" : "";
      expect({fmt::format("static inline Real hamgen::magnitude(Real x) {{ return fabs{}(x); }}"
                          "static const Real hamgen::largest = {};",
                          suffix, precision_.largest)},
             "the vocabulary");
      return;
    }
    read_tested("c/" + name);
  }

  // A header of generator/numerics/c, word by word, with the names of this header.
  void read_tested(std::string_view numerics) {
    const std::string unknowns = std::to_string(code_.unknowns);
    const std::string degrees = code_.unknowns > 32 ? "8" : "16";
    std::string text;
    for (const CppToken& token : tokens_of(tested_text(numerics))) {
      text += is_defined(c_blocks(), token.text)  ? names_.block(token.text)
              : token.text.starts_with("History") ? names_.named(token.text)
              : token.is("Unknowns")              ? unknowns
              : token.is("Degrees")               ? degrees
              : token.is("Real")                  ? std::string(precision_.type)
                                                  : token.text;
      text += ' ';
    }
    expect_pattern(cursor_, {text}, precision_, fmt::format("numerics/{}.h", numerics));
    ++found_.blocks;
  }

  void read_pieces(const std::vector<Piece>& pieces) {
    for (const Piece& piece : pieces) std::visit([this](const auto& each) { read(each); }, piece);
  }
  void read(const Record& record) {
    expect(c_record_pattern(record), record.name);
    if (record.name == "Parameters") expect(c_defaults_pattern(record), "default_parameters");
    if (record.name == "Start") expect(c_start_pattern(record), "start");
  }
  void read(const Propagator& propagator) {
    for (const ShellPart& part : c_propagator_parts(propagator)) {
      if (const auto* pattern = std::get_if<Pattern>(&part)) expect(*pattern, "Propagator");
      if (const auto* routine = std::get_if<Routine>(&part)) read(*routine, &propagator);
    }
  }
  void read(const StepOfPropagator&) { expect(c_step_pattern(), "step"); }
  void read(const ArrayMatrix&) { throw TextDifference(cursor_.line(), "C has no matrices"); }
  void read(const Watch&) { throw TextDifference(cursor_.line(), "C has no events"); }
  // `run`: what a run is, of a routine that is given it.
  void read(const Routine& routine, const Propagator* run = nullptr) {
    const int line = cursor_.line();
    if (!cursor_.peek().is("static") || !cursor_.peek(1).is("inline"))
      throw TextDifference(line, routine.name + " is not static and inline");
    const CppFunction function = without_addresses(take_function(), code_, run);
    if (function.name != routine.name)
      throw TextDifference(line, fmt::format("'{}' where {} belongs", function.name, routine.name));
    const Record* kept = run == nullptr ? nullptr : &run->record;
    RoutineReader(function, routine, {.precision = precision_, .c = true, .run = kept}).compare();
    ++found_.routines;
    found_.instructions += instructions_of(routine.body);
  }

  [[nodiscard]] bool ends(std::size_t ahead) const {
    return cursor_.peek(ahead).kind == CppToken::Kind::end ||
           cursor_.peek(ahead).kind == CppToken::Kind::directive;
  }

  CppFunction take_function() {
    const std::size_t begin = cursor_.position();
    int depth = 0;
    do {
      if (ends(0)) throw TextNotUnderstood(cursor_.line(), "a function without an end");
      const CppToken& token = cursor_.take();
      depth += token.is("{") ? 1 : token.is("}") ? -1 : 0;
      if (token.is("}") && depth == 0) break;
    } while (true);
    const std::size_t end = cursor_.position();
    std::vector<CppToken> words = cpp_words(tokens_.subspan(begin, end - begin), names_);
    words.push_back({CppToken::Kind::end, "", cursor_.line()});
    TokenCursor cursor(words);
    CppFunction function = read_function(cursor);
    if (!cursor.at_end()) throw TextNotUnderstood(cursor.line(), "something behind a function");
    return function;
  }

  void once(const std::string& name, int line) {
    if (!seen_.insert(name).second) throw TextDifference(line, name + " is there twice");
  }

  void expect(const Pattern& pattern, const std::string& what) {
    expect_pattern(cursor_, {names_.text(pattern.text), pattern.constants}, precision_, what);
  }

  [[nodiscard]] std::string of_system() const { return "HAMGEN_C_SYSTEM_" + names_.system; }
  [[nodiscard]] std::string of_method() const { return "HAMGEN_C_METHOD_" + names_.method; }

  const CFamily& family_;
  std::span<const CppToken> tokens_;
  TokenCursor cursor_;
  const Precision& precision_;
  const Program& code_;
  ReadBack& found_;
  CNames names_;
  Contents contents_;
  std::set<std::string> seen_;
};

}  // namespace

const CFamily* family_of(std::span<const CppToken> tokens) {
  for (const CFamily& family : c_families()) {
    if (tokens.size() > 1 && tokens[1].text == family.opening.front()) return &family;
  }
  return nullptr;
}

void read_c_file(std::span<const CppToken> tokens, const Precision& precision,
                 const Program& program, ReadBack& found) {
  const CFamily& family = *family_of(tokens);
  const bool has_scalar =
      family.scalars.empty()
          ? !precision.is_quad()
          : std::ranges::find(family.scalars, precision.type) != family.scalars.end();
  if (!has_scalar)
    throw TextDifference(1, fmt::format("{} has no {}", family.language, precision.type));
  CFileReader(in_c11(tokens, family, precision), family, precision, program, found).run();
}

}  // namespace hamgen
