#include "generator/base/diagnostic.hpp"

#include <gtest/gtest.h>

#include <string>

namespace hamgen {
namespace {

// What is shown of a mistake in the bytes [begin, end).
std::string shown(const std::string& text, std::size_t begin, std::size_t end) {
  return render({Severity::error, {begin, end}, "wrong", {}}, make_source("x", text));
}

TEST(Diagnostic, marks_its_place_by_columns_and_not_by_bytes) {
  EXPECT_EQ(shown("a\n\xC3\xA9\xC3\xA9 bad\n", 7, 10),
            "x:2:4: error: wrong\n"
            "  2 | \xC3\xA9\xC3\xA9 bad\n"
            "    |    ^~~\n");
}

TEST(Diagnostic, shows_a_tab_as_one_column) {
  EXPECT_EQ(shown("\tbad", 1, 4), "x:1:2: error: wrong\n  1 |  bad\n    |  ^~~\n");
}

TEST(Diagnostic, marks_only_the_first_of_several_lines) {
  EXPECT_EQ(shown("one (\ntwo)", 4, 10), "x:1:5: error: wrong\n  1 | one (\n    |     ^\n");
}

TEST(Diagnostic, can_stand_at_the_end_of_a_text) {
  EXPECT_EQ(shown("one\n", 4, 4), "x:2:1: error: wrong\n  2 |\n    | ^\n");
  EXPECT_EQ(shown("one", 3, 3), "x:1:4: error: wrong\n  1 | one\n    |    ^\n");
}

TEST(Diagnostic, cuts_a_long_line_around_its_place) {
  const std::string text = std::string(200, 'a') + "bad" + std::string(200, 'c');
  EXPECT_EQ(shown(text, 200, 203),
            "x:1:201: error: wrong\n"
            "  1 | ..." +
                std::string(50, 'a') + "bad" + std::string(47, 'c') + "...\n" + "    | " +
                std::string(53, ' ') + "^~~\n");
}

TEST(Diagnostic, prints_twenty_and_counts_the_rest) {
  const SourceText source = make_source("x", "q");
  const std::vector<Diagnostic> many(23, {Severity::error, {0, 1}, "wrong", "write p"});
  const std::string text = ModelError(many, source).what();
  EXPECT_TRUE(text.ends_with("help: write p\nand 3 more\n"));
}

TEST(Nearest, is_a_name_that_may_have_been_meant) {
  const std::vector<std::string> names = {"theta", "eps", "q1", "q2", "Omega"};
  EXPECT_EQ(nearest("thta", names), "theta");
  EXPECT_EQ(nearest("esp", names), "eps");
  EXPECT_EQ(nearest("omega", names), "Omega");
  EXPECT_EQ(nearest("q3", names), "q1");
  EXPECT_EQ(nearest("x", names), "");
  EXPECT_EQ(nearest("velocity", names), "");
}

TEST(Source, of_a_missing_file_or_a_folder_is_a_usage_error) {
  EXPECT_THROW(static_cast<void>(read_source("no/such/file.ham")), UsageError);
  EXPECT_THROW(static_cast<void>(read_source("/")), UsageError);
  EXPECT_THROW(static_cast<void>(read_source("/dev/zero")), UsageError);
}

}  // namespace
}  // namespace hamgen
