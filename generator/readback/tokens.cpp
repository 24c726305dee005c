#include "generator/readback/tokens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "generator/readback/findings.hpp"

namespace hamgen {

namespace {

constexpr std::array<std::string_view, 16> kLongSigns = {"::", "++", "--", "+=", "-=", "*=",
                                                         "/=", "==", "!=", "<=", ">=", "&&",
                                                         "||", "->", "##", "..."};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

// A backslash, or the trigraph that is one for compilers that know trigraphs.
bool ends_with_backslash(std::string_view line) {
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  return line.ends_with('\\') || line.ends_with("?\?/");
}

// Does a line within the text end with a backslash?
bool goes_on(std::string_view text) {
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    if (ends_with_backslash(text.substr(0, end))) return true;
    text.remove_prefix(end + 1);
  }
  return false;
}

// A carriage return within a line ends it for some compilers and not for others.
void require_plain(std::string_view text) {
  int line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char next = i + 1 < text.size() ? text[i + 1] : '\n';
    if (text[i] == '\n') ++line;
    if (text[i] == '\r' && next != '\n')
      throw TextNotUnderstood(line, "a carriage return within a line");
  }
}

class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}

  std::vector<CppToken> run() {
    require_plain(text_);
    while (skip_blanks()) next();
    add(CppToken::Kind::end, "");
    return std::move(tokens_);
  }

 private:
  [[nodiscard]] char at(std::size_t i) const { return i < text_.size() ? text_[i] : '\0'; }
  [[nodiscard]] bool comment_begins() const {
    return at(at_) == '/' && (at(at_ + 1) == '/' || at(at_ + 1) == '*');
  }

  // False at the end of the text.
  bool skip_blanks() {
    while (at_ < text_.size()) {
      if (text_[at_] == '\n') {
        ++line_;
        ++at_;
        line_begins_ = true;
      } else if (is_blank(text_[at_])) {
        ++at_;
      } else if (comment_begins()) {
        skip_comment();
      } else {
        return true;
      }
    }
    return false;
  }

  // A line that ends with a backslash, and blanks, goes on in the next one: a comment too.
  void skip_comment() {
    const bool to_line_end = text_[at_ + 1] == '/';
    const std::size_t end = to_line_end ? text_.find('\n', at_) : text_.find("*/", at_ + 2);
    if (!to_line_end && end == std::string_view::npos)
      throw TextNotUnderstood(line_, "a comment without an end");
    const std::string_view comment = text_.substr(at_, end - at_);
    if (goes_on(comment) || (to_line_end && ends_with_backslash(comment)))
      throw TextNotUnderstood(line_, "a comment that goes on in the next line");
    line_ += static_cast<int>(std::ranges::count(comment, '\n'));
    at_ = end == std::string_view::npos ? text_.size() : end + (to_line_end ? 0 : 2);
  }

  void next() {
    const char c = text_[at_];
    if (c == '#' && line_begins_) return directive();
    line_begins_ = false;
    if (is_letter(c))
      return run_of(CppToken::Kind::word, [](char d) { return is_letter(d) || is_digit(d); });
    if (is_digit(c) || (c == '.' && is_digit(at(at_ + 1)))) return number();
    if (c == '"' || c == '\'') return quoted(c);
    sign();
  }

  template <class Belongs>
  void run_of(CppToken::Kind kind, const Belongs& belongs) {
    const std::size_t begin = at_;
    while (at_ < text_.size() && belongs(text_[at_])) ++at_;
    add(kind, text_.substr(begin, at_ - begin));
  }

  void number() {
    const std::size_t begin = at_;
    const bool hexadecimal = at(at_ + 1) == 'x' || at(at_ + 1) == 'X';
    while (at_ < text_.size()) {
      const char c = text_[at_];
      const char before = at_ == begin ? ' ' : text_[at_ - 1];
      const bool after_power =
          hexadecimal ? before == 'p' || before == 'P' : before == 'e' || before == 'E';
      if (!is_digit(c) && !is_letter(c) && c != '.' && !((c == '+' || c == '-') && after_power))
        break;
      ++at_;
    }
    add(CppToken::Kind::number, text_.substr(begin, at_ - begin));
  }

  void quoted(char mark) {
    const std::size_t begin = at_++;
    while (at_ < text_.size() && text_[at_] != mark && text_[at_] != '\n')
      at_ += text_[at_] == '\\' ? 2 : 1;
    if (at(at_) != mark) throw TextNotUnderstood(line_, "a string without an end");
    ++at_;
    add(CppToken::Kind::quoted, text_.substr(begin, at_ - begin));
  }

  void sign() {
    for (const std::string_view sign : kLongSigns) {
      if (text_.substr(at_).starts_with(sign)) {
        at_ += sign.size();
        return add(CppToken::Kind::sign, sign);
      }
    }
    constexpr std::string_view kSigns = "+-*/%<>=!&|^?:;,.()[]{}~";
    if (kSigns.find(text_[at_]) == std::string_view::npos)
      throw TextNotUnderstood(line_, fmt::format("the character '{}'", text_[at_]));
    add(CppToken::Kind::sign, text_.substr(at_++, 1));
  }

  void directive() {
    const int begins = line_;
    std::string words;
    bool more = true;
    while (more && at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      std::string part(text_.substr(at_, end - at_));
      const std::size_t comment = part.find("//");
      if (comment != std::string::npos && ends_with_backslash(part))
        throw TextNotUnderstood(line_, "a comment that goes on in the next line");
      part.resize(std::min(part.size(), comment));
      while (!part.empty() && is_blank(part.back())) part.pop_back();
      more = part.ends_with('\\');
      if (more) part.back() = ' ';
      for (const char c : part) {
        const bool blank = is_blank(c);
        if (!blank || (!words.empty() && words.back() != ' ')) words += blank ? ' ' : c;
      }
      at_ = more ? end + 1 : end;
      if (more) ++line_;
    }
    while (words.ends_with(' ')) words.pop_back();
    tokens_.push_back({CppToken::Kind::directive, words, begins});
  }

  void add(CppToken::Kind kind, std::string_view text) {
    tokens_.push_back({kind, std::string(text), line_});
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
  bool line_begins_ = true;
  std::vector<CppToken> tokens_;
};

}  // namespace

std::vector<CppToken> tokens_of(std::string_view text) { return Lexer(text).run(); }

const CppToken& TokenCursor::peek(std::size_t ahead) const {
  return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
}

const CppToken& TokenCursor::take() {
  const CppToken& token = peek();
  if (at_ + 1 < tokens_.size()) ++at_;
  return token;
}

bool TokenCursor::accept(std::string_view text) {
  if (!peek().is(text)) return false;
  take();
  return true;
}

void TokenCursor::expect(std::string_view text) {
  if (!accept(text))
    throw TextNotUnderstood(line(), fmt::format("'{}' where '{}' was expected", peek().text, text));
}

std::string TokenCursor::word() {
  if (peek().kind != CppToken::Kind::word)
    throw TextNotUnderstood(line(), fmt::format("'{}' where a name was expected", peek().text));
  return take().text;
}

}  // namespace hamgen
