#include "app/output/font_subset.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "app/output/font_bytes.hpp"
#include "app/output/font_outlines.hpp"

namespace hamgen::app {
namespace {

using Tables = std::map<std::string, std::string, std::less<>>;

Tables read_tables(std::string_view font) {
  const FontBytes bytes(font);
  if (bytes.part(0, 4) != "OTTO") throw FontError("not an OpenType font with outlines in CFF");
  Tables tables;
  for (std::size_t i = 0; i < bytes.word(4); ++i) {
    const std::size_t at = 12 + 16 * i;
    tables[std::string(bytes.part(at, 4))] =
        bytes.part(bytes.long_word(at + 8), bytes.long_word(at + 12));
  }
  for (const char* name :
       {"CFF ", "MATH", "OS/2", "cmap", "head", "hhea", "hmtx", "maxp", "name", "post"}) {
    if (!tables.contains(name)) throw FontError(std::string("no table ") + name);
  }
  return tables;
}

// Glyphs by character, from the subtable of all of Unicode.
std::map<char32_t, std::size_t> read_characters(const FontBytes& cmap,
                                                std::span<const char32_t> characters) {
  constexpr std::size_t groups = 12;  // the format
  std::map<char32_t, std::size_t> glyphs;
  for (std::size_t i = 0; i < cmap.word(2); ++i) {
    const FontBytes table = cmap.from(cmap.long_word(4 + 8 * i + 4));
    if (table.word(0) != groups) continue;
    for (std::size_t k = 0; k < table.long_word(12); ++k) {
      const std::size_t at = 16 + 12 * k;
      const std::size_t first = table.long_word(at);
      const std::size_t last = table.long_word(at + 4);
      for (const char32_t c : characters) {
        if (c >= first && c <= last) glyphs[c] = table.long_word(at + 8) + (c - first);
      }
    }
    return glyphs;
  }
  throw FontError("no table of characters that is understood");
}

std::string characters_table(const std::map<char32_t, std::size_t>& glyphs) {
  std::string groups;
  for (const auto& [character, glyph] : glyphs)
    groups += font_number(character, 4) + font_number(character, 4) + font_number(glyph, 4);
  return font_number(0, 2) + font_number(1, 2) + font_number(3, 2) + font_number(10, 2) +
         font_number(12, 4) + font_number(12, 2) + font_number(0, 2) +
         font_number(16 + groups.size(), 4) + font_number(0, 4) + font_number(glyphs.size(), 4) +
         groups;
}

// Glyphs of a coverage table, in order.
std::vector<std::size_t> coverage(const FontBytes& table) {
  std::vector<std::size_t> glyphs;
  const std::size_t count = table.word(2);
  for (std::size_t i = 0; i < count; ++i) {
    if (table.word(0) == 1) {
      glyphs.push_back(table.word(4 + 2 * i));
    } else {
      for (std::size_t glyph = table.word(4 + 6 * i); glyph <= table.word(6 + 6 * i); ++glyph)
        glyphs.push_back(glyph);
    }
  }
  return glyphs;
}

// The larger forms of a glyph, and the parts that one of any size is put together from.
void keep_construction(const FontBytes& table, std::vector<bool>& kept) {
  const std::size_t assembly = table.word(0);
  for (std::size_t i = 0; i < table.word(2); ++i) kept.at(table.word(4 + 4 * i)) = true;
  if (assembly == 0) return;
  const FontBytes parts = table.from(assembly);
  for (std::size_t i = 0; i < parts.word(4); ++i) kept.at(parts.word(6 + 10 * i)) = true;
}

void keep_larger_forms(const FontBytes& math, std::vector<bool>& kept) {
  if (math.word(8) == 0) return;
  const FontBytes variants = math.from(math.word(8));
  const std::vector<bool> asked = kept;
  std::size_t offset = 10;
  for (const std::size_t direction : {std::size_t{0}, std::size_t{1}}) {
    const std::size_t cover = variants.word(2 + 2 * direction);
    const std::size_t count = variants.word(6 + 2 * direction);
    const auto glyphs = cover == 0 ? std::vector<std::size_t>() : coverage(variants.from(cover));
    for (std::size_t i = 0; i < count; ++i, offset += 2) {
      if (i < glyphs.size() && asked.at(glyphs[i]))
        keep_construction(variants.from(variants.word(offset)), kept);
    }
  }
}

std::size_t checksum(std::string_view text) {
  std::size_t sum = 0;
  for (std::size_t at = 0; at < text.size(); at += 4)
    sum += FontBytes(std::string(text.substr(at, 4)).append(3, '\0')).long_word(0);
  return sum & 0xFFFFFFFF;
}

std::string font_text(const Tables& tables) {
  std::string head = "OTTO" + font_number(tables.size(), 2);
  std::size_t power = 1;
  std::size_t exponent = 0;
  for (; 2 * power <= tables.size(); power *= 2) ++exponent;
  head += font_number(16 * power, 2) + font_number(exponent, 2) +
          font_number(16 * (tables.size() - power), 2);
  std::string body;
  for (const auto& [name, text] : tables) {
    head += name + font_number(checksum(text), 4) +
            font_number(12 + 16 * tables.size() + body.size(), 4) + font_number(text.size(), 4);
    body += text;
    body.append((4 - text.size() % 4) % 4, '\0');
  }
  return head + body;
}

}  // namespace

std::string font_subset(std::string_view font, std::span<const char32_t> characters) {
  try {
    Tables tables = read_tables(font);
    const auto glyphs = read_characters(FontBytes(tables.at("cmap")), characters);
    std::vector<bool> kept(FontBytes(tables.at("maxp")).word(4), false);
    kept.at(0) = true;  // what stands for a character that is missing
    for (const auto& [character, glyph] : glyphs) kept.at(glyph) = true;
    keep_larger_forms(FontBytes(tables.at("MATH")), kept);
    tables.at("CFF ") = kept_outlines(tables.at("CFF "), kept);
    tables.at("cmap") = characters_table(glyphs);
    for (const char* name : {"GSUB", "GPOS", "GDEF", "FFTM", "DSIG"}) tables.erase(name);
    return font_text(tables);
  } catch (const std::out_of_range&) {
    throw FontError("a glyph that it does not have");
  }
}

}  // namespace hamgen::app
