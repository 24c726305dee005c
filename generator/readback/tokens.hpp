// The words of an emitted file: C++ without its comments and the width of its lines.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hamgen {

struct CppToken {
  // A directive is a line that begins with #, as one token with single blanks.
  enum class Kind { word, number, quoted, sign, directive, end };
  Kind kind = Kind::end;
  std::string text;
  int line = 0;  // of the file, from 1
  [[nodiscard]] bool is(std::string_view what) const {
    return kind != Kind::quoted && kind != Kind::directive && text == what;
  }
};

// Ends with a token of kind `end`.  Throws TextNotUnderstood for what is no token.
[[nodiscard]] std::vector<CppToken> tokens_of(std::string_view text);

// Where a reader of tokens stands.
class TokenCursor {
 public:
  explicit TokenCursor(std::span<const CppToken> tokens) : tokens_(tokens) {}

  [[nodiscard]] const CppToken& peek(std::size_t ahead = 0) const;
  [[nodiscard]] bool at_end() const { return peek().kind == CppToken::Kind::end; }
  [[nodiscard]] int line() const { return peek().line; }
  const CppToken& take();
  // Takes the token if it is this one.
  bool accept(std::string_view text);
  // Throws TextNotUnderstood unless it is.
  void expect(std::string_view text);
  [[nodiscard]] std::string word();
  [[nodiscard]] std::size_t position() const { return at_; }
  void go_to(std::size_t position) { at_ = position; }

 private:
  std::span<const CppToken> tokens_;  // the last one is the end
  std::size_t at_ = 0;
};

}  // namespace hamgen
