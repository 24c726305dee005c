#include "app/output/font_outlines.hpp"

#include <algorithm>

#include "app/output/font_bytes.hpp"

namespace hamgen::app {
namespace {

// An INDEX of CFF: texts one after the other.
struct FontIndex {
  std::vector<std::string_view> items;
  std::size_t end = 0;  // of it, in the table
};

FontIndex read_index(const FontBytes& table, std::size_t at) {
  const std::size_t count = table.word(at);
  FontIndex index{.items = {}, .end = at + 2};
  if (count == 0) return index;
  const std::size_t width = table.byte(at + 2);
  if (width < 1 || width > 4) throw FontError("an index with offsets of this size");
  const std::size_t base = at + 2 + (count + 1) * width;  // offsets begin with 1
  const auto offset = [&](std::size_t i) { return table.number(at + 3 + i * width, width); };
  for (std::size_t i = 0; i < count; ++i) {
    if (offset(i + 1) < offset(i)) throw FontError("an index that goes back");
    index.items.push_back(table.part(base + offset(i), offset(i + 1) - offset(i)));
  }
  index.end = base + offset(count);
  return index;
}

std::string index_text(const std::vector<std::string_view>& items) {
  if (items.empty()) return font_number(0, 2);
  std::size_t size = 1;
  for (const std::string_view item : items) size += item.size();
  const std::size_t width = size < 1u << 8 ? 1 : size < 1u << 16 ? 2 : size < 1u << 24 ? 3 : 4;
  std::string text = font_number(items.size(), 2) + font_number(width, 1);
  std::size_t offset = 1;
  text += font_number(offset, width);
  for (const std::string_view item : items) text += font_number(offset += item.size(), width);
  for (const std::string_view item : items) text += item;
  return text;
}

constexpr std::size_t kCharset = 15;
constexpr std::size_t kCharStrings = 17;
constexpr std::size_t kPrivate = 18;

// What is used of the font's top DICT.
struct TopDict {
  std::string other;  // entries that hold no offset and no name, as they are
  std::size_t char_strings = 0;
  std::size_t private_size = 0;
  std::size_t private_at = 0;
};

// The number at a place of a DICT, and how long it is; of a real number only the length.
std::pair<std::size_t, std::size_t> operand(const FontBytes& dict, std::size_t at) {
  const std::size_t first = dict.byte(at);
  if (first == 28) return {dict.word(at + 1), 3};
  if (first == 29) return {dict.long_word(at + 1), 5};
  if (first == 30) {
    std::size_t length = 1;
    for (; (dict.byte(at + length) & 0xF) != 0xF; ++length)
      if (dict.byte(at + length) >> 4 == 0xF) break;
    return {0, length + 1};
  }
  if (first >= 32 && first <= 246) return {first - 139, 1};
  if (first >= 247 && first <= 250) return {(first - 247) * 256 + dict.byte(at + 1) + 108, 2};
  if (first >= 251 && first <= 254) return {0, 2};  // negative: no offset
  throw FontError("no operand of a DICT");
}

TopDict read_top_dict(const FontBytes& dict) {
  TopDict result;
  std::vector<std::size_t> operands;
  std::size_t begin = 0;
  for (std::size_t at = 0; at < dict.size();) {
    const std::size_t code = dict.byte(at);
    if (code > 21) {
      const auto [value, length] = operand(dict, at);
      operands.push_back(value);
      at += length;
      continue;
    }
    at += code == 12 ? 2 : 1;
    if (code == 12 && dict.byte(at - 1) >= 30) throw FontError("a font by character identifiers");
    const bool is_box = code == 5;
    if (code == kCharStrings && operands.size() == 1) result.char_strings = operands[0];
    if (code == kPrivate && operands.size() == 2) {
      result.private_size = operands[0];
      result.private_at = operands[1];
    }
    if (is_box || (code == 12 && dict.byte(at - 1) != 0 && dict.byte(at - 1) != 21 &&
                   dict.byte(at - 1) != 22))
      result.other += dict.part(begin, at - begin);
    operands.clear();
    begin = at;
  }
  if (result.char_strings == 0 || result.private_at == 0) throw FontError("no outlines");
  return result;
}

std::string entry(std::initializer_list<std::size_t> operands, std::size_t code) {
  std::string text;
  for (const std::size_t value : operands) text += '\x1D' + font_number(value, 4);
  return text + font_number(code, 1);
}

}  // namespace

std::string kept_outlines(std::string_view bytes, const std::vector<bool>& kept) {
  const FontBytes table(bytes);
  const FontIndex names = read_index(table, table.byte(2));
  const FontIndex dicts = read_index(table, names.end);
  const FontIndex strings = read_index(table, dicts.end);
  const FontIndex routines = read_index(table, strings.end);
  if (dicts.items.size() != 1) throw FontError("not one font");
  const TopDict top = read_top_dict(FontBytes(dicts.items[0]));
  const FontIndex outlines = read_index(table, top.char_strings);
  const std::size_t count = outlines.items.size();
  if (count < 2 || count != kept.size()) throw FontError("other glyphs than it says");

  constexpr std::string_view nothing = "\x0E";  // endchar
  std::vector<std::string_view> items;
  for (std::size_t i = 0; i < count; ++i) items.push_back(kept[i] ? outlines.items[i] : nothing);

  // Names are numbers of strings: those behind the 391 that every font has, all of them empty.
  constexpr std::size_t standard_strings = 391;
  const std::string charset =
      font_number(2, 1) + font_number(standard_strings, 2) + font_number(count - 2, 2);
  const std::string glyphs = index_text(items);
  // Behind it lie its own subroutines, at a distance that it names.
  const std::string_view last = table.part(top.private_at, table.size() - top.private_at);
  const auto text = [&](std::size_t charset_at) {
    const std::size_t glyphs_at = charset_at + charset.size();
    const std::string dict = top.other + entry({charset_at}, kCharset) +
                             entry({glyphs_at}, kCharStrings) +
                             entry({top.private_size, glyphs_at + glyphs.size()}, kPrivate);
    return std::string(table.part(0, table.byte(2))) + index_text(names.items) +
           index_text({dict}) + index_text(std::vector<std::string_view>(count - 1)) +
           index_text(routines.items);
  };
  // Offsets take five bytes whatever they are.
  return text(text(0).size()) + charset + glyphs + std::string(last);
}

}  // namespace hamgen::app
