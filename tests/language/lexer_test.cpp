#include "generator/language/lexer.hpp"

#include <gtest/gtest.h>

#include <string>

namespace hamgen {
namespace {

// The words of a text, one a line, newlines shown as "--" with the comment before them.
std::string words_of(const std::string& text) {
  const SourceText source = make_source("x.ham", text);
  std::string words;
  for (const Token& token : read_tokens(source).tokens) {
    if (token.kind == TokenKind::unit) words += "unit ";
    if (token.kind == TokenKind::newline) words += "-- ";
    words += std::string(token.text) + "|";
  }
  return words;
}

TEST(Lexer, a_bracket_after_a_space_is_a_unit) {
  EXPECT_EQ(words_of("q[1] [m/s]  # far"), "q|[|1|]|unit m/s|-- far||");
  EXPECT_EQ(words_of("m = [1, 2]"), "m|=|[|1|,|2|]|-- ||");
}

TEST(Lexer, a_range_is_no_decimal) {
  EXPECT_EQ(words_of("1..N 1.5 .5 2. 1e3"), "1|..|N|1.5|.5|2.|1e3|-- ||");
}

TEST(Lexer, an_open_parenthesis_carries_a_statement_over_the_line) {
  EXPECT_EQ(words_of("a = (b # one\n + c) # two\nd"), "a|=|(|b|+|c|)|-- two|d|-- ||");
}

TEST(Lexer, a_keyword_ends_the_statement_whatever_is_open) {
  EXPECT_EQ(words_of("let a = (b\nH = c"), "let|a|=|(|b|-- |H|=|c|-- ||");
}

TEST(Lexer, windows_line_ends_are_line_ends_and_no_part_of_a_comment) {
  EXPECT_EQ(words_of("a = (b # one\r\n + c) # two\r\nd [m]\r\n"),
            words_of("a = (b # one\n + c) # two\nd [m]\n"));
}

TEST(Lexer, a_tab_may_stand_in_a_comment_and_in_a_unit) {
  EXPECT_EQ(words_of("q [m\ts] # a\tb"), "q|unit m\ts|-- a\tb||");
}

}  // namespace
}  // namespace hamgen
