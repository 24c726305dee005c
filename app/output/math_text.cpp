#include "app/output/math_text.hpp"

#include <fmt/format.h>

#include <cctype>
#include <string>
#include <vector>

#include "app/output/math_symbol.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

constexpr std::string_view kTimes = "<mo>&#x2062;</mo><mspace width='0.14em'/>";
constexpr std::string_view kRelations = "=<>";

bool is_alphabetic(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_numeral(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

std::string as_row(const std::string& inside) { return "<mrow>" + inside + "</mrow>"; }

// Reads a line from left to right: atoms, with what stands above or below them, and operators.
class MathLine {
 public:
  explicit MathLine(std::string_view text) : text_(text) {}

  // Until the closing sign, or the end; of the outermost row a part for each relation in it.
  std::vector<std::string> parts(char close = 0) {
    std::vector<std::string> result = {""};
    bool after_atom = false;
    bool spaced = false;
    while (at_ < text_.size() && (close == 0 || text_[at_] != close)) {
      const char c = text_[at_];
      if (c == ' ') {
        spaced = true;
        ++at_;
        continue;
      }
      if (starts_atom(c)) {
        if (after_atom && spaced) result.back() += kTimes;
        result.back() += with_scripts(atom());
        after_atom = true;
      } else {
        if (close == 0 && kRelations.find(c) != std::string_view::npos) result.emplace_back();
        // "h^9 -2e-05 f" is a product.
        if (c == '-' && after_atom && spaced && is_numeral(ahead(1))) {
          ++at_;
          result.back() += std::string(kTimes) + negative_number();
        } else {
          result.back() += sign(after_atom);
          after_atom = false;
        }
      }
      spaced = false;
    }
    return result;
  }

 private:
  [[nodiscard]] char ahead(std::size_t n) const {
    return at_ + n < text_.size() ? text_[at_ + n] : '\0';
  }
  static bool starts_atom(char c) {
    return is_alphabetic(c) || is_numeral(c) || c == '(' || c == '{' || c == '|';
  }

  // Of a binary or a leading sign, a comma, dots.
  std::string sign(bool after_atom) {
    if (text_.substr(at_, 3) == "...") {
      at_ += 3;
      return "<mo>…</mo>";
    }
    const char c = text_[at_++];
    if (c == '*') return std::string(kTimes);
    if (c == '/') return "<mo lspace='0' rspace='0'>/</mo>";
    const std::string shown = c == '-' ? "−" : html_text(std::string(1, c));
    const bool leads = (c == '-' || c == '+') && !after_atom;
    return fmt::format("<mo{}>{}</mo>", leads ? " form='prefix'" : "", shown);
  }

  std::string fenced(char open, char close) {
    ++at_;
    const std::string inside = parts(close).front();
    if (at_ < text_.size()) ++at_;
    const char* const mark = "<mo stretchy='false'>{}</mo>";
    return as_row(fmt::format(fmt::runtime(mark), open) + inside +
                  fmt::format(fmt::runtime(mark), close));
  }

  // "1e-06" is a power of ten.
  std::string number() {
    const std::size_t begin = at_;
    while (is_numeral(ahead(0)) || (ahead(0) == '.' && is_numeral(ahead(1)))) ++at_;
    std::string text = fmt::format("<mn>{}</mn>", text_.substr(begin, at_ - begin));
    const std::size_t signs = ahead(1) == '-' || ahead(1) == '+' ? 2 : 1;
    if (ahead(0) != 'e' || !is_numeral(ahead(signs))) return text;
    const bool is_small = ahead(1) == '-';
    at_ += signs;
    while (ahead(0) == '0' && is_numeral(ahead(1))) ++at_;
    const std::size_t digits = at_;
    while (is_numeral(ahead(0))) ++at_;
    return as_row(fmt::format("{}<mo>×</mo><msup><mn>10</mn><mrow>{}<mn>{}</mn></mrow></msup>",
                              text, is_small ? "<mo form='prefix'>−</mo>" : "",
                              text_.substr(digits, at_ - digits)));
  }

  std::string negative_number() {
    return as_row("<mo stretchy='false'>(</mo><mo form='prefix'>−</mo>" + number() +
                  "<mo stretchy='false'>)</mo>");
  }

  std::string word() {
    const std::size_t begin = at_;
    while (is_alphabetic(ahead(0)) || is_numeral(ahead(0))) ++at_;
    const std::string_view name = text_.substr(begin, at_ - begin);
    if (name == "grad") return "<mo lspace='0' rspace='0'>∇</mo>";
    if (name == "w") return "<mi>ω</mi>";
    // "hA" and "iy" are products.
    if (name == "hA" || name == "iy")
      return fmt::format("<mi>{}</mi><mi>{}</mi>", name[0], name[1]);
    const SymbolMarkup symbol = symbol_markup(name);
    if (symbol.subscript.empty()) return symbol.letter;
    return fmt::format("<msub>{}{}</msub>", symbol.letter, as_row(symbol.subscript));
  }

  std::string atom() {
    const char c = text_[at_];
    if (c == '(') return fenced('(', ')');
    if (c == '{') return fenced('{', '}');
    if (c == '|') return fenced('|', '|');
    return is_numeral(c) ? number() : word();
  }

  // The sign in "A+ J" and "A-^T" belongs to the letter.
  [[nodiscard]] bool is_index_sign() const {
    const char c = ahead(0);
    const char next = ahead(1);
    return (c == '+' || c == '-') && is_alphabetic(text_[at_ - 1]) &&
           (next == ' ' || next == '^' || next == '\0');
  }

  // "_ij" or "_(s+1-i)(s+1-j)"; "^T", "^-1", "^(3)".
  std::string script() {
    std::string inside;
    if (ahead(0) == '(') {
      const bool is_power = text_[at_ - 1] == '^';
      while (ahead(0) == '(') {
        ++at_;
        std::string group = parts(')').front();
        if (at_ < text_.size()) ++at_;
        if (is_power) return "<mo stretchy='false'>(</mo>" + group + "<mo stretchy='false'>)</mo>";
        inside += (inside.empty() ? "" : "<mo>,</mo>") + group;
      }
      return inside;
    }
    if (ahead(0) == '-') inside += sign(false);
    if (is_numeral(ahead(0))) return inside + number();
    for (; is_alphabetic(ahead(0)); ++at_)
      inside += text_[at_] == 'T' ? "<mi mathvariant='normal'>T</mi>"
                                  : fmt::format("<mi>{}</mi>", text_[at_]);
    return inside;
  }

  std::string with_scripts(const std::string& base) {
    std::string below;
    std::string above;
    if (is_index_sign()) below = fmt::format("<mo>{}</mo>", text_[at_++] == '-' ? "−" : "+");
    for (; ahead(0) == '\''; ++at_)
      above += std::string(above.empty() ? "<mspace width='0.15em'/>" : "") +
               "<mo lspace='0' rspace='0'>′</mo>";
    while (ahead(0) == '_' || ahead(0) == '^') {
      std::string& place = text_[at_++] == '_' ? below : above;
      place += script();
    }
    if (below.empty() && above.empty()) return base;
    if (above.empty()) return fmt::format("<msub>{}{}</msub>", as_row(base), as_row(below));
    if (below.empty()) return fmt::format("<msup>{}{}</msup>", as_row(base), as_row(above));
    return fmt::format("<msubsup>{}{}{}</msubsup>", as_row(base), as_row(below), as_row(above));
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

// A line may end in a longer one.
std::string formula_in_prose(std::string_view text) {
  constexpr std::size_t shortest = 30;
  if (text.size() < shortest) return "<math>" + math_line(text) + "</math>";
  std::string result;
  for (const std::string& part : MathLine(text).parts()) {
    if (!part.empty()) result += (result.empty() ? "<math>" : "<wbr><math>") + part + "</math>";
  }
  return result;
}

}  // namespace

std::string math_line(std::string_view text) {
  std::string line;
  for (const std::string& part : MathLine(text).parts()) line += part;
  return line;
}

std::string math_prose(std::string_view text) {
  std::string result;
  bool inside = false;
  while (true) {
    const std::size_t end = text.find('`');
    const std::string_view part = text.substr(0, end);
    result += inside ? formula_in_prose(part) : html_text(part);
    if (end == std::string_view::npos) return result;
    text.remove_prefix(end + 1);
    inside = !inside;
  }
}

}  // namespace hamgen::app
