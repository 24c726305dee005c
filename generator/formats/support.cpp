#include "generator/formats/support.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <span>
#include <sstream>

#include "generator/base/fixed_blocks.hpp"
#include "generator/base/short_digest.hpp"
#include "generator/formats/numerics.hpp"

namespace hamgen {

namespace {

// The words of C++ code, without comments and without members: what follows a dot.
std::set<std::string> words_of(std::string_view code) {
  std::set<std::string> words;
  std::istringstream lines{std::string(code)};
  for (std::string line; std::getline(lines, line);) {
    line.resize(std::min(line.size(), line.find("//")));
    std::string word;
    char before = ' ';
    for (const char c : line + ' ') {
      if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
        word += c;
        continue;
      }
      if (!word.empty() && before != '.') words.insert(word);
      word.clear();
      before = c;
    }
  }
  return words;
}

}  // namespace

void write_once(CodeWriter& out, const std::string& macro, const std::string& digest,
                std::string_view kind, const std::string& text) {
  out.line("#ifndef " + macro);
  out.line(fmt::format("#define {} 0x{}", macro, digest));
  out.lines(text);
  out.line(fmt::format("#elif {} != 0x{}", macro, digest));
  out.line(fmt::format(
      "#error \"another {} of this name is included before: generate one with --namespace\"",
      kind));
  out.line("#endif");
  out.line();
}

std::string capitals(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

std::span<const FixedBlock> Support::all_blocks() const {
  return packs_ ? pack_blocks() : lanes_ > 0 ? lane_blocks() : cpp_blocks();
}

void Support::require_for(std::string_view code) {
  const std::set<std::string> words = words_of(code);
  for (const FixedBlock& block : all_blocks()) {
    if (block.events && !events_) continue;
    const auto is_read = [&](const std::string& name) { return words.contains(name); };
    const bool used = std::ranges::any_of(names_of(block), is_read) ||
                      std::ranges::any_of(helpers_of(block), is_read);
    if (used && blocks_.insert(block.name).second) require_for(text(block.name));
  }
}

bool Support::uses_eigen() const {
  return std::ranges::any_of(cpp_blocks(), [&](const FixedBlock& block) {
    return block.eigen && blocks_.contains(block.name);
  });
}

bool Support::uses_cmath(bool shared) const {
  return !shared && lanes_ == 0 && blocks_.contains(kVocabulary) && !builtins_ &&
         scalar_.digits != 113;
}

void Support::write(CodeWriter& out, bool shared) const {
  const auto is_written = [&](const FixedBlock& block) {
    return blocks_.contains(block.name) && (block.eigen || !shared);
  };
  if (std::ranges::none_of(all_blocks(), is_written)) return;
  const std::string name = name_space();
  const bool has_bounds = std::ranges::any_of(all_blocks(), [&](const FixedBlock& block) {
    return is_written(block) && text(block.name).find("template <int") != std::string::npos;
  });
  out.line("// What follows knows nothing of the system.");
  if (has_bounds) out.lines(cpp_numerics("shells/bounds_begin"));
  out.line(fmt::format("namespace {} {{", name));
  const bool in_registers = lanes_ > 0 || packs_;
  if (in_registers) {
    out.line(fmt::format("inline namespace {} {{", kRegisters));
  } else {
    out.line(scalar_.digits == 113 ? "__extension__ typedef __float128 Real;"
                                   : fmt::format("using Real = {};", scalar_.cpp));
  }
  out.line();
  for (const FixedBlock& block : all_blocks()) {
    if (!is_written(block)) continue;
    const std::string guard = fmt::format("HAMGEN_{}_{}_{}", capitals(digest()), capitals(space()),
                                          capitals(std::string(block.name)));
    out.line("#ifndef " + guard);
    out.line("#define " + guard);
    out.lines(text(block.name));
    out.line("#endif");
    out.line();
  }
  if (in_registers) out.line(fmt::format("}}  // namespace {}", kRegisters));
  out.line(fmt::format("}}  // namespace {}", name));
  if (has_bounds) out.lines(cpp_numerics("shells/bounds_end"));
  out.line();
}

void Support::write_names(CodeWriter& out, std::string_view code) const {
  const std::set<std::string> words = words_of(code);
  const std::string alias = packs_ ? "packs" : "numerics";
  std::string list;
  for (const FixedBlock& block : all_blocks()) {
    if (block.events && !events_) continue;
    for (const std::string& name : names_of(block))
      if (words.contains(name)) list += (list.empty() ? "" : ", ") + alias + "::" + name;
  }
  if (list.empty()) return;
  out.line(fmt::format("namespace {} = ::{};", alias, name_space()));
  out.line("using " + list + ";");
  out.line();
}

const std::string& Support::digest() const {
  if (!digest_.empty()) return digest_;
  std::string all;
  for (const FixedBlock& block : all_blocks())
    if (events_ || !block.events) all += text(block.name);
  return digest_ = short_digest(all);
}

std::string Support::name_space() const { return fmt::format("hamgen_{}::{}", digest(), space()); }

std::string Support::space() const {
  if (packs_) return "packs";
  return lanes_ > 0 ? fmt::format("lanes_{}", lanes_) : std::string(scalar_.space);
}

std::string Support::text(std::string_view block) const {
  const std::string text = block != kVocabulary ? cpp_numerics(block)
                           : lanes_ > 0         ? lanes_vocabulary(scalar_, lanes_)
                                                : cpp_vocabulary(scalar_, builtins_);
  return text.substr(0, text.find_last_not_of('\n') + 1);
}

std::string shared_file_name(const ScalarType& scalar, bool events) {
  return fmt::format("hamgen_support{}{}.hpp",
                     scalar.digits == 53 ? "" : "_" + std::string(scalar.space),
                     events ? "_events" : "");
}

OutputFile shared_file(const ScalarType& scalar, bool events) {
  Support support(scalar, false, events);
  for (const FixedBlock& block : cpp_blocks()) {
    if (!block.eigen) support.require_for(block.defines);
  }
  CodeWriter out;
  out.line("// What headers that were generated with --support shared have in common.");
  out.line("//");
  out.line(fmt::format("//   made by   hamgen {}, in C++17", HAMGEN_VERSION));
  out.line("#pragma once");
  if (support.uses_cmath(false)) out.line("#include <cmath>");
  out.line();
  out.lines(ieee_begin(scalar));
  out.line();
  support.write(out, false);
  out.lines(cpp_numerics("shells/ieee_end"));
  return {shared_file_name(scalar, events), out.text()};
}

}  // namespace hamgen
