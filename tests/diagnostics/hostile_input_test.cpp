// Inputs too large or too odd to keep as files.
#include <gtest/gtest.h>

#include <string>

#include "generator/language/lexer.hpp"
#include "generator/language/parser.hpp"
#include "generator/language/read_model.hpp"

namespace hamgen {
namespace {

const std::string declarations = "coordinate q\nmomentum p\n";

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

// A token is looked at by each of the seven levels from the statement to the operand, which ask for
// two operators at most.  To go back, or through all tokens for each mistake, would be thousands.
constexpr std::size_t most_looks = 7 * 2;

// The first line of what is said of a model; reading it must not be more work than it is long.
std::string hostile_said_of(const std::string& text) {
  const SourceText source = make_source("x.ham", text);
  const std::size_t tokens = read_tokens(source).tokens.size();
  EXPECT_LE(tokens, text.size() + 2);  // one a character, a newline and the end
  EXPECT_LE(parse(source).looks, most_looks * tokens);
  std::string said = "accepted";
  try {
    static_cast<void>(read_model(source));
  } catch (const ModelError& error) {
    said = error.what();
    EXPECT_LT(said.size(), 20000U);
  }
  return said.substr(0, said.find('\n'));
}

// The same of a Hamiltonian.
std::string first_line(const std::string& hamiltonian) {
  return hostile_said_of(declarations + "H = " + hamiltonian + "\n");
}

constexpr int many = 100000;

TEST(HostileInput, deep_parentheses_meet_the_nesting_limit) {
  EXPECT_EQ(first_line(repeated("(", many) + "q" + repeated(")", many)),
            "x.ham:3:205: error: nested deeper than 200 levels");
}

// The word after them would be looked for from each of them: hours, not milliseconds.
TEST(HostileInput, empty_lines_in_parentheses_are_read_once) {
  EXPECT_EQ(first_line("p^2/2 + (q" + repeated("\n", 4000000) + " + 1)"), "accepted");
  EXPECT_EQ(first_line("(q" + repeated(" \r\n", 1000000) + repeated("w", 100000)),
            "x.ham:1000003:1: error: name too long: 100000 characters");
}

TEST(HostileInput, parentheses_without_end_meet_the_nesting_limit) {
  EXPECT_EQ(first_line(repeated("(", many)), "x.ham:3:205: error: nested deeper than 200 levels");
}

TEST(HostileInput, many_signs_meet_the_nesting_limit) {
  EXPECT_EQ(first_line(repeated("-", many) + "q"),
            "x.ham:3:205: error: nested deeper than 200 levels");
}

TEST(HostileInput, deep_calls_meet_the_nesting_limit) {
  EXPECT_EQ(first_line(repeated("sin(", many) + "q" + repeated(")", many)),
            "x.ham:3:808: error: nested deeper than 200 levels");
}

TEST(HostileInput, a_tower_of_powers_meets_the_nesting_limit) {
  EXPECT_EQ(first_line(repeated("q^", many) + "q"),
            "x.ham:3:406: error: nested deeper than 200 levels");
}

TEST(HostileInput, deep_sums_and_subscripts_meet_the_nesting_limit) {
  EXPECT_EQ(first_line(repeated("sum(i = 1..2, ", many)),
            "x.ham:3:2808: error: nested deeper than 200 levels");
  EXPECT_EQ(first_line(repeated("q[", many)), "x.ham:3:406: error: nested deeper than 200 levels");
}

TEST(HostileInput, two_hundred_levels_are_accepted) {
  EXPECT_EQ(first_line(repeated("(", 200) + "q" + repeated(")", 200)), "accepted");
}

TEST(HostileInput, a_flat_sum_has_a_limit) {
  EXPECT_EQ(first_line("q" + repeated("+q", many)),
            "x.ham:3:4005: error: more than 2000 operations in one expression");
  EXPECT_EQ(first_line("q" + repeated("+q", 1999)), "accepted");
}

TEST(HostileInput, long_sums_inside_deep_parentheses_have_the_same_limit) {
  const std::string level = repeated("+q", 100) + ")";
  EXPECT_EQ(first_line(repeated("(", 190) + "q" + repeated(level, 190)),
            "x.ham:3:4214: error: more than 2000 operations in one expression");
}

TEST(HostileInput, many_wrong_lines_are_looked_at_one_by_one) {
  EXPECT_EQ(hostile_said_of(repeated("x\n", many)), "x.ham:1:1: error: unknown statement 'x'");
}

TEST(HostileInput, a_name_of_a_megabyte_is_too_long) {
  EXPECT_EQ(first_line(repeated("a", 1000000)),
            "x.ham:3:5: error: name too long: 1000000 characters");
}

TEST(HostileInput, a_number_of_a_megabyte_is_too_long) {
  EXPECT_EQ(first_line(repeated("1", 1000000)),
            "x.ham:3:5: error: number too long: 1000000 characters");
}

TEST(HostileInput, a_nul_byte_is_named_with_its_offset) {
  EXPECT_EQ(first_line(std::string("q\0p", 3)), "x.ham:3:6: error: illegal byte 0x00 at offset 29");
  EXPECT_EQ(first_line(std::string("q # \0", 5)),
            "x.ham:3:9: error: illegal byte 0x00 at offset 32");
}

TEST(HostileInput, an_escape_sequence_does_not_reach_the_terminal) {
  const SourceText source = make_source("\x1b[2J", "coordinate \x1b[31mq\n");
  try {
    static_cast<void>(read_model(source));
    FAIL();
  } catch (const ModelError& error) {
    EXPECT_EQ(std::string(error.what()).find('\x1b'), std::string::npos);
  }
}

TEST(HostileInput, bytes_of_every_value_are_survived) {
  std::string bytes;
  for (int i = 0; i < 1000000; ++i) bytes += static_cast<char>(i * 2654435761U >> 13U);
  EXPECT_NE(first_line(bytes), "accepted");
}

TEST(HostileInput, a_byte_order_mark_and_windows_line_ends_are_accepted) {
  const SourceText source =
      make_source("x.ham",
                  "\xEF\xBB\xBFsystem s\r\ncoordinate q  # angle\r\nmomentum p\r\n"
                  "H = p^2/2 +\t(q^2\r\n  + q^4)\r\n");
  EXPECT_EQ(to_text(read_model(source)),
            "system s\n"
            "coordinate q  # angle\n"
            "momentum p\n"
            "H = p^2/2 + (q^2 + q^4)\n");
}

}  // namespace
}  // namespace hamgen
