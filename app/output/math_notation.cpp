#include "app/output/math_notation.hpp"

#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include "app/output/math_markup.hpp"

namespace hamgen::app {
namespace {

constexpr std::string_view kRelations = "=<>,";

bool is_alphabetic(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_numeral(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_of_word(char c) { return is_alphabetic(c) || is_numeral(c); }

// relations of sums of products of what has scripts, from left to right.
class NotationReader {
 public:
  explicit NotationReader(std::string_view text) : text_(text) {}

  MathFormula whole() {
    MathFormula result = relation();
    while (at_ < text_.size()) {  // a bracket too many, half a formula
      ++at_;
      if (at_ < text_.size()) result = product_of(result, relation());
    }
    return result;
  }

 private:
  [[nodiscard]] char ahead(std::size_t n = 0) const {
    return at_ + n < text_.size() ? text_[at_ + n] : '\0';
  }
  bool skip_blanks() {
    const std::size_t before = at_;
    while (ahead() == ' ') ++at_;
    return at_ > before;
  }
  bool take(char c) {
    skip_blanks();
    if (ahead() != c) return false;
    ++at_;
    return true;
  }

  MathFormula relation() {
    std::string signs;
    std::vector<MathFormula> parts = {sum()};
    while (skip_blanks(),
           at_ < text_.size() && kRelations.find(ahead()) != std::string_view::npos) {
      signs += text_[at_++];
      parts.push_back(sum());
    }
    return related(signs, parts);
  }

  MathFormula sum() {
    const bool is_negative = take('-');
    MathFormula result = product();
    if (is_negative) result = negated(result);
    while (skip_blanks(), ahead() == '+' || ahead() == '-') {
      const bool falls = text_[at_++] == '-';
      const MathFormula term = product();
      result = falls ? difference_of(result, term) : sum_of(result, term);
    }
    return result;
  }

  // "h^9 -2e-05 f" has three factors.
  [[nodiscard]] bool starts_negative_factor(bool spaced) const {
    return spaced && ahead() == '-' && is_numeral(ahead(1));
  }
  [[nodiscard]] bool starts_factor() const {
    return is_of_word(ahead()) || ahead() == '(' || ahead() == '{' ||
           (ahead() == '|' && !in_size_) || text_.substr(at_, 3) == "...";
  }

  MathFormula product() {
    skip_blanks();
    MathFormula result = factor();
    while (true) {
      const bool spaced = skip_blanks();
      if (ahead() == '/') {
        ++at_;
        skip_blanks();
        result = quotient_of(result, factor());
      } else if (ahead() == '*') {
        ++at_;
        skip_blanks();
        result = product_of(result, factor());
      } else if (starts_factor()) {
        result = product_of(result, factor());
      } else if (starts_negative_factor(spaced)) {
        ++at_;
        result = product_of(result, negated(factor()));
      } else {
        return result;
      }
    }
  }

  std::vector<MathFormula> list(char close) {
    ++at_;
    MathFormula inside = relation();
    if (ahead() == close) ++at_;
    const bool is_list = inside.kind == MathKind::relation &&
                         inside.text.find_first_not_of(',') == std::string::npos;
    return is_list ? std::move(inside.parts) : std::vector{std::move(inside)};
  }

  MathFormula group() {
    std::vector<MathFormula> inside = list(')');
    if (inside.size() == 1) return std::move(inside.front());
    return in_brackets("()", inside);
  }

  // "1e-06" is a power of ten.
  MathFormula number() {
    const std::size_t begin = at_;
    while (is_numeral(ahead()) || (ahead() == '.' && is_numeral(ahead(1)))) ++at_;
    const MathFormula mantissa = math_number(std::string(text_.substr(begin, at_ - begin)));
    const std::size_t sign = ahead(1) == '-' || ahead(1) == '+' ? 1 : 0;
    if (ahead() != 'e' || !is_numeral(ahead(1 + sign))) return mantissa;
    const bool is_small = ahead(1) == '-';
    at_ += 1 + sign;
    while (ahead() == '0' && is_numeral(ahead(1))) ++at_;
    const std::size_t digits = at_;
    while (is_numeral(ahead())) ++at_;
    const MathFormula size = math_number(std::string(text_.substr(digits, at_ - digits)));
    const MathFormula power = power_of(math_number("10"), is_small ? negated(size) : size);
    return mantissa.text == "1" ? power : product_of(mantissa, power);
  }

  std::string name() {
    const std::size_t begin = at_;
    while (is_of_word(ahead()) || (ahead() == '_' && is_of_word(ahead(1)))) ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }

  // "_(s+1-i)(s+1-j)"
  std::vector<MathFormula> subscripts() {
    std::vector<MathFormula> all;
    if (ahead() != '_' || ahead(1) != '(') return all;
    for (++at_; ahead() == '(';) all.push_back(group());
    return all;
  }

  // The sign in "A+ J" and "A-^T" belongs to the letter.
  [[nodiscard]] bool is_index_sign() const {
    const char next = ahead(1);
    return (ahead() == '+' || ahead() == '-') && (next == ' ' || next == '^' || next == '\0');
  }

  MathFormula word() {
    const std::string read = name();
    if (read == "grad") return math_mark("∇");
    if (read == "hA" || read == "iy")  // products
      return product_of(math_symbol(read.substr(0, 1)), math_symbol(read.substr(1)));
    if (ahead() == '[') {
      const std::size_t end = std::min(text_.find(']', at_), text_.size());
      const std::string index(text_.substr(at_ + 1, end - at_ - 1));
      at_ = std::min(end + 1, text_.size());
      return with_subscript(read, read_notation(index));
    }
    if (ahead() == '(') return call_of(read, list(')'));
    MathFormula symbol = math_symbol(read);
    symbol.parts = subscripts();
    if (is_index_sign()) symbol.parts = {math_mark(text_[at_++] == '-' ? "−" : "+")};
    return symbol;
  }

  MathFormula atom() {
    switch (ahead()) {
      case '(':
        return group();
      case '{':
        return in_brackets("{}", list('}'));
      case '|': {
        const bool outside = std::exchange(in_size_, true);
        MathFormula size = call_of("abs", list('|'));
        in_size_ = outside;
        return size;
      }
      default:
        break;
    }
    if (text_.substr(at_, 3) == "...") {
      at_ += 3;
      return math_mark("…");
    }
    if (is_numeral(ahead())) return number();
    if (is_alphabetic(ahead())) return word();
    if (at_ == text_.size() || kRelations.find(ahead()) != std::string_view::npos ||
        ahead() == ')' || ahead() == '}')
      return math_mark("");  // a formula that ends in the middle
    return math_mark(std::string(1, text_[at_++]));
  }

  // "^T", "^-1", "^(1/2)"; the brackets of "f^(4)", a derivative, are kept.
  MathFormula exponent() {
    if (ahead() == '-') {
      ++at_;
      return negated(exponent());
    }
    if (is_numeral(ahead())) return number();
    if (ahead() == '(') {
      MathFormula inside = group();
      return inside.kind == MathKind::number ? in_brackets("()", {inside}) : inside;
    }
    const std::string read = name();
    return read == "T" ? math_mark("T") : math_symbol(read);
  }

  MathFormula factor() {
    MathFormula result = atom();
    std::string primes;
    for (; ahead() == '\''; ++at_) primes += "′";
    if (!primes.empty()) result = power_of(result, math_mark(primes));
    while (ahead() == '^') {
      ++at_;
      result = power_of(result, exponent());
    }
    if (ahead() == '!') {
      ++at_;
      result = call_of("!", {result});
    }
    // "f''(f,f)", "f^(4)(f,f)"
    if (ahead() == '(' && result.kind == MathKind::power) return applied(result, list(')'));
    return result;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool in_size_ = false;  // between | and |
};

}  // namespace

MathFormula read_notation(std::string_view text) { return NotationReader(text).whole(); }

}  // namespace hamgen::app
