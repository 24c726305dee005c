#include "generator/formats/c_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <variant>

#include "generator/base/diagnostic.hpp"
#include "generator/base/fixed_blocks.hpp"
#include "generator/base/short_digest.hpp"
#include "generator/formats/c_dialect.hpp"
#include "generator/formats/c_pieces.hpp"
#include "generator/formats/numerics.hpp"
#include "generator/formats/preamble.hpp"
#include "generator/formats/support.hpp"

namespace hamgen {

namespace {

// What there are no blocks for in C.
std::string missing(const Instruction& instruction) {
  const auto& value = instruction.value;
  if (std::holds_alternative<Matrix>(value) || std::holds_alternative<Invert>(value))
    return "matrices";
  const bool fixed_point =
      std::holds_alternative<Refine>(value) || std::holds_alternative<RefineArray>(value) ||
      std::holds_alternative<IterateArray>(value) || std::holds_alternative<Alternate>(value);
  return fixed_point ? "fixed points" : "";
}

void require_c(const CFamily& family, const EmitContext& context) {
  const std::string_view format = family.format;
  const bool all_scalars = family.scalars.empty();
  const auto refuse = [&](const std::string& what) {
    throw UsageError(fmt::format(
        "--format {}: {}\nhelp: what is written in C are steps that are explicit, or solved by "
        "Newton's iteration of a size up to 3, in {}{}",
        format, what,
        all_scalars ? "float, double or long double"
                    : fmt::format("{}", fmt::join(family.scalars, " or ")),
        all_scalars ? "; C can call any other one as a plugin: --format cpp-plugin" : ""));
  };
  if (context.options.lanes > 0) {
    throw UsageError(
        fmt::format("--format {}: there are no lanes in C\nhelp: --format cpp-header", format));
  }
  if (context.quad()) refuse(fmt::format("{} has no quad numbers", family.language));
  const bool has_scalar =
      all_scalars || std::ranges::find(family.scalars, context.scalar.cpp) != family.scalars.end();
  if (!has_scalar) refuse(fmt::format("{} has no {}", family.language, context.scalar.cpp));
  if (context.arrays()) refuse("there are no loops over degrees of freedom in C");
  if (context.options.tangent) refuse("there is no tangent map in C");
  if (context.options.shared_support) {
    throw UsageError(fmt::format(
        "--format {}: there is no shared support in C\nhelp: leave out --support", format));
  }
  if (const Field* own = parameter_of_method(context.contents))
    refuse(fmt::format("'{}' is a parameter of the method", own->name));
  for (const Piece& piece : context.contents.method) {
    const auto* const routine = std::get_if<Routine>(&piece);
    if (routine == nullptr) continue;
    const std::string found = find_in(routine->body, missing);
    if (!found.empty()) refuse("there are no " + found + " in C");
  }
}

// Is the statement of this line at its end, or the line a comment?
bool ends_here(std::string_view line) {
  const std::size_t last = line.substr(0, line.find("//")).find_last_not_of(' ');
  return last == line.npos || std::string_view(";{}").find(line[last]) != std::string_view::npos;
}

// A block, each statement in a line: with other names it is broken elsewhere.
std::string unbroken(const std::string& text) {
  std::string result;
  bool goes_on = false;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    const std::string line = text.substr(begin, end - begin);
    result += goes_on ? " " + line.substr(line.find_first_not_of(' ')) : line;
    goes_on = !ends_here(line);
    if (!goes_on) result += '\n';
    begin = end + 1;
  }
  return result;
}

// The text of a block with our names for its own.
std::string block_text(std::string_view name, const CDialect& dialect, int unknowns = 0) {
  const auto renamed = [&](const std::string& word) -> std::string {
    if (word == "Real") return dialect.real();
    if (word == "Unknowns") return std::to_string(unknowns);
    if (word == "Degrees") return unknowns > 32 ? "8" : "16";
    if (word.starts_with("History")) return dialect.named(word);
    return is_defined(c_blocks(), word) ? dialect.block(word) : word;
  };
  std::string result;
  std::string word;
  bool in_comment = false;
  for (const char c : unbroken(c_numerics(name, dialect.scalar, dialect.function("fabs")))) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
      word += c;
      continue;
    }
    result += (in_comment ? word : renamed(word)) + c;
    in_comment = c != '\n' && (in_comment || result.ends_with("//"));
    word.clear();
  }
  return result;
}

void write_section(CodeWriter& out, const std::string& macro, const std::string& text) {
  write_once(out, macro, short_digest(text), "text", text);
}

void write_pi(CodeWriter& out, const CDialect& dialect) {
  const Rational pi = *parse_decimal("3.14159265358979323846264338327950288419716939937510");
  const std::string name = dialect.constant("pi");
  write_section(
      out, "HAMGEN_C_" + name,
      fmt::format("static const {} {} = {};\n", dialect.real(), name, literal(pi, dialect.scalar)));
}

// The fixed blocks that the text uses, and those that these use.
void write_blocks(CodeWriter& out, const CDialect& dialect, std::string text) {
  std::vector<std::pair<std::string, std::string>> blocks;
  for (std::size_t i = c_blocks().size(); i-- > 0;) {
    const FixedBlock& block = c_blocks()[i];
    const bool used = std::ranges::any_of(names_of(block), [&](const std::string& name) {
      return text.find(dialect.block(name)) != std::string::npos;
    });
    if (!used) continue;
    blocks.emplace(blocks.begin(), block.name, block_text(block.name, dialect));
    text += blocks.front().second;
  }
  out.line("// What follows knows nothing of the system.");
  for (const auto& [name, block] : blocks) {
    const std::string guard = fmt::format("HAMGEN_C_{}_{}", dialect.scalar.space, name);
    write_section(out, capitals(guard), block);
  }
}

}  // namespace

OutputFiles c_header_files(std::string_view format, const Program& program,
                           const EmitOptions& options) {
  const CFamily& family = c_family_of_format(format);
  if (!program.events.empty()) {
    throw UsageError(fmt::format(
        "--events with --format {}: C has no functions to be called for an event\n"
        "help: a cpp-header has them; invariant NAME = EXPR in the model is a value in C, too",
        format));
  }
  const CDialect dialect(family, find_scalar(options.scalar), options.spaces);
  EmitContext context(program, options, dialect);
  require_c(family, context);
  CodeWriter system;
  write_pieces(system, context, dialect, context.contents.system);
  CodeWriter method;
  const int unknowns = program.unknowns;
  if (unknowns > 0) method.lines(block_text("history", dialect, unknowns) + "\n");
  if (program.record("Derivatives") != nullptr)
    method.lines(block_text("ahead", dialect, unknowns) + "\n");
  write_pieces(method, context, dialect, context.contents.method);
  CodeWriter out;
  write_preamble(out, context);
  out.line("#pragma once");
  for (const std::string_view line : family.opening) out.line(std::string(line));
  out.line();
  out.lines(ieee_begin(context.scalar));
  out.line();
  if (context.used.pi) write_pi(out, dialect);
  write_section(out, "HAMGEN_C_SYSTEM_" + dialect.system(), system.text());
  write_blocks(out, dialect, method.text());
  write_section(out, "HAMGEN_C_METHOD_" + dialect.method(), method.text());
  out.lines(cpp_numerics("shells/ieee_end"));
  return {{options.file_name + std::string(family.extension), in_words_of(family, out.text())}};
}

}  // namespace hamgen
