#include "generator/readback/fixed_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "generator/base/numerics_text.hpp"
#include "generator/readback/findings.hpp"
#include "generator/readback/pattern.hpp"

namespace hamgen {

namespace {

constexpr const char* kRegistersBegin = "inline namespace HAMGEN_REGISTERS {";
constexpr std::string_view kIncludes[] = {"<cmath>", "<algorithm>", "<vector>", "<Eigen/SparseLU>",
                                          "<Eigen/LU>"};
std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}
std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool is_directive(const TokenCursor& cursor, std::string_view begin) {
  return cursor.peek().kind == CppToken::Kind::directive && cursor.peek().text.starts_with(begin);
}

// Bounds of arrays that are a template's int, of which g++ warns.
bool begins_bounds(const TokenCursor& cursor) {
  return is_directive(cursor, "#if defined __GNUC__");
}

// __extension__ __float128 sinq(__float128) noexcept;
void read_quad_functions(TokenCursor& cursor, const Precision& precision) {
  expect_pattern(cursor, {"extern \"C\" {"}, precision, "the functions of quad numbers");
  while (!cursor.accept("}")) {
    expect_pattern(cursor, {"__extension__ __float128"}, precision, "a quad function");
    const int line = cursor.line();
    const std::string name = cursor.word();
    const bool two = name == "powq" || name == "atan2q";
    if (!name.ends_with('q')) throw TextDifference(line, name + " is no quad function");
    expect_pattern(cursor, {two ? "(__float128, __float128) noexcept;" : "(__float128) noexcept;"},
                   precision, name);
  }
}

// The lines between two lines of the text, both left out.
std::string lines_between(std::string_view text, int first, int last) {
  std::string result;
  int line = 1;
  for (std::size_t begin = 0; begin < text.size() && line < last; ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (line > first) result += std::string(text.substr(begin, end - begin)) + '\n';
    begin = end + 1;
  }
  return result;
}

std::string trimmed(std::string_view text) {
  return std::string(text.substr(0, text.find_last_not_of(" \r\n") + 1));
}

// The first line in which the texts differ, from 0.
int first_difference(const std::string& a, const std::string& b) {
  int line = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()) && a[i] == b[i]; ++i) {
    if (a[i] == '\n') ++line;
  }
  return line;
}

// Of packs of so many numbers.
void expect_lane_vocabulary(TokenCursor& cursor, const Precision& precision, int lanes) {
  const std::string text = fmt::format(
      "using Real = Pack<{0}>; using Mask = LaneMask<{0}>;"
      "inline Real magnitude(const Real& x) {{ return lane_abs(x); }}"
      "inline constexpr double largest = {1}; inline constexpr double epsilon = 0x1p-{2};",
      lanes, precision.largest, precision.bits - 1);
  expect_pattern(cursor, {text}, precision, "the vocabulary");
}

void expect_vocabulary(TokenCursor& cursor, const Precision& precision) {
  const std::string suffix = precision.bits == 24 ? "f" : precision.bits == 64 ? "l" : "";
  std::string magnitude = "std::fabs(x)";
  if (precision.is_quad()) magnitude = "x < 0 ? -x : x";
  const std::string builtin = "__builtin_fabs" + suffix;
  expect_pattern(cursor, {"inline Real magnitude(Real x) { return"}, precision, "the vocabulary");
  if (!precision.is_quad() && cursor.peek().is(builtin)) magnitude = builtin + "(x)";
  const std::string least = fmt::format("0x1p-{}{}", precision.bits - 1, precision.suffix);
  const auto number = [&](std::string_view text) {
    return precision.is_quad() ? fmt::format("Real({})", text) : std::string(text);
  };
  expect_pattern(cursor,
                 {fmt::format("{}; }} inline constexpr Real largest = {};"
                              "inline constexpr Real epsilon = {};",
                              magnitude, number(precision.largest), number(least))},
                 precision, "the vocabulary");
}

void skip_to_end(TokenCursor& cursor) {
  for (int depth = 1;;) {
    if (cursor.at_end()) throw TextNotUnderstood(cursor.line(), "a block without its #endif");
    if (is_directive(cursor, "#if")) ++depth;
    if (is_directive(cursor, "#endif") && --depth == 0) return;
    cursor.take();
  }
}

// #ifndef guard, #define guard, the header, #endif
std::string read_block(TokenCursor& cursor, std::string_view text, const std::string& prefix,
                       const Precision& precision, int lanes) {
  const std::string macro = cursor.peek().text.substr(std::string("#ifndef ").size());
  const int begin = cursor.line();
  if (!macro.starts_with(prefix)) throw TextDifference(begin, macro + " guards no fixed block");
  const std::string name = lower(macro.substr(prefix.size()));
  cursor.take();
  const int first = cursor.line();
  expect_directive(cursor, "#define " + macro);
  if (name == kVocabulary && lanes > 0) {
    expect_lane_vocabulary(cursor, precision, lanes);
  } else if (name == kVocabulary) {
    expect_vocabulary(cursor, precision);
  } else {
    const auto found = std::ranges::find(all_numerics(), name, &NumericsText::name);
    if (found == all_numerics().end())
      throw TextDifference(begin, fmt::format("there is no fixed block '{}'", name));
    skip_to_end(cursor);
    const std::string written = trimmed(lines_between(text, first, cursor.line()));
    const std::string tested = trimmed(found->text);
    if (written != tested)
      throw TextDifference(first + 1 + first_difference(written, tested),
                           fmt::format("not the text of numerics/{}, which is tested", name));
  }
  expect_directive(cursor, "#endif");
  return name;
}

void expect_tested(TokenCursor& cursor, const std::string& name, const Precision& precision) {
  expect_pattern(cursor, {std::string(tested_text(name))}, precision, "numerics/" + name);
}

}  // namespace

std::string_view tested_text(std::string_view name) {
  return std::ranges::find(all_numerics(), name, &NumericsText::name)->text;
}

void expect_directive(TokenCursor& cursor, const std::string& text) {
  const CppToken& found = cursor.peek();
  if (found.kind != CppToken::Kind::directive || found.text != text)
    throw TextDifference(found.line, fmt::format("'{}' where '{}' belongs", found.text, text));
  cursor.take();
}

std::vector<std::string> read_includes(TokenCursor& cursor, const Precision& precision) {
  std::vector<std::string> files;
  for (;;) {
    if (precision.is_quad() && cursor.peek().is("extern")) {
      read_quad_functions(cursor, precision);
    } else if (is_directive(cursor, "#include ")) {
      const std::string name = cursor.peek().text.substr(std::string("#include ").size());
      const bool ours = name.size() > 2 && name.starts_with('"') && name.ends_with('"');
      if (ours) {
        files.push_back(name.substr(1, name.size() - 2));
      } else if (std::ranges::find(kIncludes, name) == std::end(kIncludes)) {
        throw TextDifference(cursor.line(), name + " is included");
      }
      cursor.take();
    } else {
      return files;
    }
  }
}

void expect_ieee_begin(TokenCursor& cursor, const Precision& precision) {
  expect_tested(cursor, "shells/ieee_flags", precision);
  if (precision.bits <= 53) expect_tested(cursor, "shells/ieee_registers", precision);
  expect_tested(cursor, "shells/ieee_begin", precision);
}

void expect_ieee_end(TokenCursor& cursor, const Precision& precision) {
  expect_tested(cursor, "shells/ieee_end", precision);
}

namespace {

// The blocks of a namespace that begins like this, and, with registers, has one within.
FixedBlocks read_space(TokenCursor& cursor, std::string_view text, const Precision& precision,
                       const std::string& space, const std::string& begin, bool registers = false,
                       int lanes = 0) {
  FixedBlocks blocks;
  const bool has_bounds = begins_bounds(cursor);
  if (has_bounds) expect_tested(cursor, "shells/bounds_begin", precision);
  cursor.expect("namespace");
  const int line = cursor.line();
  const std::string name = cursor.word();
  if (!name.starts_with("hamgen_")) throw TextDifference(line, "not the namespace of fixed blocks");
  blocks.digest = name.substr(7);
  expect_pattern(cursor, {fmt::format("::{} {{ {}", space, begin)}, precision,
                 "the namespace of fixed blocks");
  const std::string prefix = fmt::format("HAMGEN_{}_{}_", upper(blocks.digest), upper(space));
  while (is_directive(cursor, "#ifndef "))
    blocks.names.insert(read_block(cursor, text, prefix, precision, lanes));
  expect_pattern(cursor, {registers ? "}}" : "}"}, precision, "the namespace of fixed blocks");
  if (has_bounds) expect_tested(cursor, "shells/bounds_end", precision);
  return blocks;
}

}  // namespace

FixedBlocks read_blocks(TokenCursor& cursor, std::string_view text, const Precision& precision) {
  if (!cursor.peek().is("namespace") && !begins_bounds(cursor)) return {};
  const std::string type = precision.is_quad() ? "__extension__ typedef __float128 Real;"
                                               : fmt::format("using Real = {};", precision.type);
  return read_space(cursor, text, precision, std::string(precision.space), type);
}

FixedBlocks read_packs(TokenCursor& cursor, std::string_view text, const Precision& precision) {
  expect_tested(cursor, "shells/lane_registers", precision);
  return read_space(cursor, text, precision, "packs", kRegistersBegin, true);
}

FixedBlocks read_lane_blocks(TokenCursor& cursor, std::string_view text, const Precision& precision,
                             int lanes) {
  expect_tested(cursor, "shells/lane_registers", precision);
  return read_space(cursor, text, precision, fmt::format("lanes_{}", lanes), kRegistersBegin, true,
                    lanes);
}

void read_block_names(TokenCursor& cursor, const std::string& space,
                      std::span<const FixedBlock> blocks) {
  do {
    const int line = cursor.line();
    cursor.expect(space);
    cursor.expect("::");
    const std::string name = cursor.word();
    if (!is_defined(blocks, name)) throw TextDifference(line, name + " is no fixed block");
  } while (cursor.accept(","));
  cursor.expect(";");
}

}  // namespace hamgen
