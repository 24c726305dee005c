#include "app/output/math_font.hpp"

#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "app/output/font_subset.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

constexpr std::string_view kFontFile = "texgyrepagella-math.otf";
// Of Debian's package fonts-texgyre-math, and of TeX Live.
constexpr std::array<std::string_view, 3> kFontDirectories = {
    "/usr/share/texmf/fonts/opentype/public/tex-gyre-math",
    "/usr/share/texlive/texmf-dist/fonts/opentype/public/tex-gyre-math",
    "/usr/share/fonts/opentype/tex-gyre-math"};

void add_range(std::vector<char32_t>& characters, char32_t first, char32_t last) {
  for (char32_t c = first; c <= last; ++c) characters.push_back(c);
}

// Upright letters, italic ones (Latin and Greek, where a browser puts a single letter), digits,
// operators.
std::vector<char32_t> formula_characters() {
  std::vector<char32_t> characters;
  add_range(characters, U' ', U'~');
  add_range(characters, 0x1D434, 0x1D467);  // italic A to z, but h:
  characters.push_back(0x210E);
  add_range(characters, 0x1D6E2, 0x1D71B);  // italic Alpha to pi
  add_range(characters, 0x391, 0x3C9);
  for (const char32_t c : U"\u00A0·˙˜‖′−√∑∂∇∞≈≠≤≥…\u2061\u2062|{}ϕϵ→×±∈") {
    if (c != 0) characters.push_back(c);
  }
  return characters;
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned block = 0;
    for (std::size_t k = 0; k < 3; ++k)
      block = block << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[block >> (18 - 6 * k) & 63u];
  }
  return text;
}

std::string math_font_style() {
  for (const std::string_view directory : kFontDirectories) {
    const std::filesystem::path file = std::filesystem::path(directory) / kFontFile;
    std::error_code failed;
    if (!std::filesystem::is_regular_file(file, failed)) continue;
    try {
      const std::string font = font_subset(runtime::read_file(file), formula_characters());
      return "@font-face { font-family: Formula; src: url(data:font/otf;base64," + base64(font) +
             ") format('opentype'); }\n";
    } catch (const FontError&) {
      continue;
    } catch (const runtime::ToolError&) {
      continue;  // it cannot be read
    }
  }
  return "";
}

}  // namespace hamgen::app
