// The words of a .ham file.
#pragma once

#include <string_view>
#include <vector>

#include "generator/base/diagnostic.hpp"
#include "generator/base/source_text.hpp"

namespace hamgen {

enum class TokenKind {
  name,
  number,
  unit,     // the text between brackets that follow a space: "q [rad]"
  symbol,   // operators and punctuation
  newline,  // end of a statement; its text is the comment that stands before it, if any
  bad,      // an illegal character or number, already reported
  end,
};

struct Token {
  TokenKind kind = TokenKind::end;
  Span span;
  std::string_view text;  // a view into SourceText::text
};

[[nodiscard]] inline bool is_symbol(const Token& token, std::string_view text) {
  return token.kind == TokenKind::symbol && token.text == text;
}

struct Tokens {
  std::vector<Token> tokens;  // the last one is `end`, and a newline stands before it
  std::vector<Diagnostic> diagnostics;
};

}  // namespace hamgen
