#include "generator/language/lexer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "generator/base/utf8.hpp"
#include "generator/language/words.hpp"

namespace hamgen {
namespace {

constexpr std::size_t longest_number = 1000;
constexpr std::size_t most_errors = 100;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_name_character(char c) { return is_letter(c) || is_digit(c) || c == '_'; }
bool is_blank(char c) { return c == ' ' || c == '\t'; }

// The names of the Greek letters from alpha (U+03B1) to omega (U+03C9).
constexpr std::array<std::string_view, 25> greek = {
    "alpha", "beta",   "gamma",   "delta", "epsilon", "zeta",    "eta",  "theta", "iota",
    "kappa", "lambda", "mu",      "nu",    "xi",      "omicron", "pi",   "rho",   "sigma",
    "sigma", "tau",    "upsilon", "phi",   "chi",     "psi",     "omega"};

class Lexer {
 public:
  explicit Lexer(const SourceText& source) : text_(source.text) {}

  Tokens run() {
    while (at_ < text_.size() && result_.diagnostics.size() < most_errors) read_one();
    end_line(at_);
    add(TokenKind::end, text_.size(), text_.size());
    return std::move(result_);
  }

 private:
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }

  // LF or CR LF.
  bool at_line_end() const { return peek() == '\n' || (peek() == '\r' && peek(1) == '\n'); }

  void add(TokenKind kind, std::size_t begin, std::size_t end) {
    result_.tokens.push_back({kind, {begin, end}, text_.substr(begin, end - begin)});
  }

  void fail(std::size_t begin, std::size_t end, std::string message, std::string help) {
    result_.diagnostics.push_back(
        {Severity::error, {begin, end}, std::move(message), std::move(help)});
    add(TokenKind::bad, begin, end);
  }

  void read_one() {
    const char c = peek();
    if (at_line_end()) {
      end_line(at_);
      at_ += c == '\r' ? 2 : 1;
    } else if (is_blank(c)) {
      ++at_;
    } else if (c == '#') {
      read_comment();
    } else if (is_letter(c)) {
      read_name();
    } else if (is_digit(c) || (c == '.' && is_digit(peek(1)))) {
      read_number();
    } else if (c == '[' && starts_unit()) {
      read_unit();
    } else {
      read_symbol();
    }
  }

  // The word that begins the line after the one that ends here.  Empty lines in a row have the same
  // one: it is looked for once.
  std::string_view next_word(std::size_t newline) {
    if (newline < word_begin_) return word_;
    word_begin_ = std::min(text_.find_first_not_of(" \t\r\n", newline), text_.size());
    std::size_t end = word_begin_;
    while (end < text_.size() && is_name_character(text_[end])) ++end;
    word_ = text_.substr(word_begin_, end - word_begin_);
    return word_;
  }

  void end_line(std::size_t newline) {
    const bool last = newline >= text_.size();
    if (open_ > 0 && !last && !begins_statement(next_word(newline))) {
      comment_ = {};
      return;
    }
    open_ = 0;
    result_.tokens.push_back({TokenKind::newline, {newline, newline}, comment_});
    comment_ = {};
  }

  void read_comment() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && !at_line_end()) pass_character();
    std::size_t from = begin;
    while (from < at_ && (text_[from] == '#' || is_blank(text_[from]))) ++from;
    std::size_t to = at_;
    while (to > from && is_blank(text_[to - 1])) --to;
    comment_ = text_.substr(from, to - from);
  }

  // Passes over one character of a comment or a unit, with a report if it is illegal.  What is
  // emitted quotes them.
  void pass_character() {
    const std::optional<CodePoint> point = code_point_at(text_, at_);
    if (!point) return illegal_byte();
    if (is_control(point->value) && peek() != '\t') return control_character(*point);
    at_ += point->length;
  }

  void control_character(const CodePoint& point) {
    const std::size_t begin = at_;
    if (peek() != '\r' && point.length == 1) return illegal_byte();
    at_ += point.length;
    if (point.length == 1) {
      return fail(
          begin, at_, fmt::format("a carriage return without a line feed at offset {}", begin),
          "end lines with LF or CR LF: some programs take a lone CR for a line's end, others "
          "do not");
    }
    fail(begin, at_,
         fmt::format("illegal character U+{:04X} at offset {}",
                     static_cast<std::uint32_t>(point.value), begin),
         "remove it: it would show a reader something else than the compiler sees");
  }

  void illegal_byte() {
    const auto byte = static_cast<unsigned char>(peek());
    fail(at_, at_ + 1, fmt::format("illegal byte 0x{:02X} at offset {}", byte, at_),
         byte < 0x80 ? "remove it" : "save the file as UTF-8");
    ++at_;
  }

  void read_name() {
    const std::size_t begin = at_;
    while (is_name_character(peek())) ++at_;
    if (at_ - begin > longest_name) {
      fail(begin, at_, fmt::format("name too long: {} characters", at_ - begin),
           fmt::format("a name has at most {} characters", longest_name));
      return;
    }
    add(TokenKind::name, begin, at_);
  }

  void read_number() {
    const std::size_t begin = at_;
    while (is_digit(peek())) ++at_;
    if (text_[begin] == '0' && at_ == begin + 1 && (peek() == 'x' || peek() == 'X')) {
      return malformed(begin, "hexadecimal numbers are not known; write it in decimal");
    }
    if (peek() == '.' && peek(1) != '.') {
      ++at_;
      while (is_digit(peek())) ++at_;
      if (peek() == '.' && peek(1) != '.') return malformed(begin, "a number has one point");
    }
    if (peek() == 'e' || peek() == 'E') {
      const std::size_t sign = peek(1) == '+' || peek(1) == '-' ? 1 : 0;
      if (is_digit(peek(1 + sign))) {
        at_ += 1 + sign;
        while (is_digit(peek())) ++at_;
      } else if (!is_name_character(peek(1))) {
        return malformed(begin, "write 1e5 for a power of ten, or 1*e for a product");
      }
    }
    if (at_ - begin > longest_number) {
      fail(begin, at_, fmt::format("number too long: {} characters", at_ - begin),
           fmt::format("a number has at most {} characters", longest_number));
      return;
    }
    add(TokenKind::number, begin, at_);
  }

  void malformed(std::size_t begin, std::string help) {
    while (is_name_character(peek()) || peek() == '.') ++at_;
    const std::string_view shown = text_.substr(begin, std::min<std::size_t>(at_ - begin, 30));
    fail(begin, at_, fmt::format("malformed number '{}'", shown), std::move(help));
  }

  // After a complete operand and a space, '[' opens a unit; directly after a name, a subscript.
  bool starts_unit() const {
    if (result_.tokens.empty() || at_ == 0 || !is_blank(text_[at_ - 1])) return false;
    const Token& before = result_.tokens.back();
    return before.kind == TokenKind::name || before.kind == TokenKind::number ||
           before.kind == TokenKind::unit || is_symbol(before, ")") || is_symbol(before, "]");
  }

  void read_unit() {
    const std::size_t begin = at_++;
    const std::size_t inside = at_;
    while (at_ < text_.size() && peek() != ']' && peek() != '#' && !at_line_end()) pass_character();
    if (peek() != ']') {
      fail(begin, begin + 1, "'[' is never closed", "write the unit on one line, as in q [rad]");
      return;
    }
    ++at_;
    result_.tokens.push_back(
        {TokenKind::unit, {begin, at_}, text_.substr(inside, at_ - 1 - inside)});
  }

  void read_symbol() {
    static constexpr std::array<std::string_view, 9> doubles = {
        "**", "..", "==", "<=", ">=", "!=", "&&", "||", "~="};
    static constexpr std::string_view seconds = "*.=&|";  // of the words in doubles
    static constexpr std::string_view singles = "+-*/^()[]{},;=<>!&|%:";
    const char c = peek();
    const std::size_t begin = at_;
    const bool may_be_double =
        at_ + 1 < text_.size() && seconds.find(text_[at_ + 1]) < seconds.size();
    if (may_be_double && std::ranges::find(doubles, text_.substr(at_, 2)) != doubles.end()) {
      at_ += 2;
    } else if (singles.find(c) != std::string_view::npos && c != '\0') {
      ++at_;
      if (c == '(' || c == '[') ++open_;
      if ((c == ')' || c == ']') && open_ > 0) --open_;
      if (c == '{' || c == '}') open_ = 0;
    } else {
      return illegal_character();
    }
    add(TokenKind::symbol, begin, at_);
  }

  void illegal_character() {
    const std::size_t begin = at_;
    const std::optional<CodePoint> point = code_point_at(text_, at_);
    const char c = peek();
    if (!point) return illegal_byte();
    if (is_control(point->value)) return control_character(*point);
    at_ += point->length;
    if (point->value < 0x80) {
      return fail(begin, at_, fmt::format("illegal character '{}'", c),
                  c == '"'    ? "texts are not part of the language"
                  : c == '\'' ? "a name has no prime; use the momentum for a velocity"
                              : "remove it");
    }
    const std::string_view shown = text_.substr(begin, point->length);
    std::string help = "names are made of the letters a-z and A-Z, digits and '_'";
    const char32_t letter = point->value;
    if (letter >= 0x3B1 && letter < 0x3B1 + greek.size()) {
      help = fmt::format("write it out: {}", greek[letter - 0x3B1]);
    }
    if (letter == 0xD7 || letter == 0xB7 || letter == 0x22C5) help = "write '*' for a product";
    if (letter == 0x2212) help = "write '-' for a difference";
    if (letter == 0xB2) help = "write '^2' for a square";
    // The rest of a foreign word is one mistake with its first letter.
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) >= 0x80) {
      const std::optional<CodePoint> next = code_point_at(text_, at_);
      if (!next || is_control(next->value)) break;
      at_ += next->length;
    }
    fail(begin, at_,
         fmt::format("illegal character '{}' (U+{:04X}) at offset {}", shown,
                     static_cast<std::uint32_t>(letter), begin),
         std::move(help));
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t open_ = 0;  // parentheses and brackets
  std::size_t word_begin_ = 0;
  std::string_view word_;
  std::string_view comment_;
  Tokens result_;
};

}  // namespace

Tokens read_tokens(const SourceText& source) { return Lexer(source).run(); }

}  // namespace hamgen
