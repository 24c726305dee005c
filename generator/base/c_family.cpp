#include "generator/base/c_family.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

const std::vector<std::string_view> kWordsOfOpenCl = {"kernel",
                                                      "global",
                                                      "local",
                                                      "constant",
                                                      "generic",
                                                      "half",
                                                      "pipe",
                                                      "read_only",
                                                      "write_only",
                                                      "read_write",
                                                      "vec_step",
                                                      "image1d_t",
                                                      "image1d_array_t",
                                                      "image1d_buffer_t",
                                                      "image2d_t",
                                                      "image2d_array_t",
                                                      "image2d_depth_t",
                                                      "image2d_array_depth_t",
                                                      "image2d_msaa_t",
                                                      "image3d_t",
                                                      "CLK_LOCAL_MEM_FENCE",
                                                      "CLK_GLOBAL_MEM_FENCE"};

const std::array kFamilies = {
    CFamily{.format = "c-header",
            .language = "C11",
            .opening = {"#include <math.h>", "#include <stdbool.h>"}},
    // Functions and types of C's headers are OpenCL C's own, of one name for all numbers. Constants
    // of a file have a memory of their own, arrays among the arguments are in that of the item,
    // addresses in any, and long has 64 bits everywhere.
    CFamily{.format = "opencl-header",
            .language = "OpenCL C 3.0",
            .extension = ".cl",
            .opening = {"#ifdef __FAST_RELAXED_MATH__",
                        "#error \"what rounding loses is kept here: build without "
                        "-cl-fast-relaxed-math\"",
                        "#endif", "#pragma OPENCL FP_CONTRACT OFF"},
            .has_suffixes = false,
            .has_array_arguments = false,
            .scalars = {"float", "double"},
            .words = {{"static const", "__constant"}, {"long long", "long"}},
            .reserved = kWordsOfOpenCl},
};

bool is_of_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// Is text[at, at + size) a word, or words, and no part of longer ones?
bool stands_alone(std::string_view text, std::size_t at, std::size_t size) {
  const bool goes_on = at + size < text.size() && is_of_word(text[at + size]);
  return !goes_on && (at == 0 || !is_of_word(text[at - 1]));
}

bool has_word(std::string_view text, std::string_view word) {
  std::size_t at = text.find(word);
  while (at != text.npos && !stands_alone(text, at, word.size())) at = text.find(word, at + 1);
  return at != text.npos;
}

// Refuses names that reserved ones would get: they could not be told from each other.
void require_free(const CFamily& family, std::string_view code) {
  for (const std::string_view name : family.reserved) {
    const std::string renamed = std::string(name) + "_";
    if (!has_word(code, renamed)) continue;
    throw UsageError(fmt::format(
        "--format {}: '{}' is what '{}', a word of {}, would be called\nhelp: rename it",
        family.format, renamed, name, family.language));
  }
}

std::string replaced(std::string line, std::string_view from, std::string_view to) {
  for (std::size_t at = line.find(from); at != line.npos; at = line.find(from, at)) {
    if (stands_alone(line, at, from.size())) line.replace(at, from.size(), to);
    ++at;
  }
  return line;
}

}  // namespace

std::span<const CFamily> c_families() { return kFamilies; }

const CFamily& c_family_of_format(std::string_view format) {
  const auto found = std::ranges::find(c_families(), format, &CFamily::format);
  if (found == c_families().end()) internal_error("no language of " + std::string(format));
  return *found;
}

const CFamily* c_family_of_file(std::string_view name) {
  for (const CFamily& family : c_families()) {
    if (name.ends_with(family.extension)) return &family;
  }
  return nullptr;
}

std::vector<std::pair<std::string, std::string>> CFamily::replacements() const {
  std::vector<std::pair<std::string, std::string>> list(words.begin(), words.end());
  for (const std::string_view name : reserved) {
    list.emplace_back(name, std::string(name) + "_");
  }
  return list;
}

std::string in_words_of(const CFamily& family, const std::string& text) {
  const auto replacements = family.replacements();
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string line = text.substr(begin, end - begin);
    const std::size_t comment = std::min(line.find("//"), line.size());
    std::string code = line.substr(0, comment);
    require_free(family, code);
    for (const auto& [from, to] : replacements) code = replaced(std::move(code), from, to);
    result += code + line.substr(comment);
    begin = end;
  }
  return result;
}

}  // namespace hamgen
