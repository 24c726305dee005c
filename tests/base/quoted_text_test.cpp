#include "generator/base/quoted_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace hamgen {
namespace {

std::string all_bytes() {
  std::string text;
  for (int byte = 0; byte < 256; ++byte) text += static_cast<char>(byte);
  return text;
}

TEST(QuotedText, ShowsControlCharactersAndIllegalBytesAndLeavesTheRest) {
  EXPECT_EQ(visible_text("a\rb\nc\td"), "a<U+000D>b<U+000A>c\td");
  EXPECT_EQ(visible_lines("a\rb\nc\td"), "a<U+000D>b\nc\td");
  EXPECT_EQ(visible_text("\u0085 \u2028 \u2029 \u202E \u2066 \u061C \u200F"),
            "<U+0085> <U+2028> <U+2029> <U+202E> <U+2066> <U+061C> <U+200F>");
  EXPECT_EQ(visible_text("\xFF\xC3"), "<0xFF><0xC3>");
  EXPECT_EQ(visible_text("ω², 1 − é"), "ω², 1 − é");
}

TEST(QuotedText, LeavesNoControlCharacterOnALine) {
  for (const std::string& text :
       {visible_text(all_bytes()), comment_text(all_bytes()), cpp_string(all_bytes()),
        gnuplot_text(all_bytes()), gnuplot_path(all_bytes()), html_text(all_bytes())}) {
    EXPECT_TRUE(std::ranges::none_of(text, [](unsigned char c) {
      return (c < 0x20 && c != '\t' && c != '\n') || c >= 0x7F;
    })) << text;
  }
  for (const std::string& text : {comment_text(all_bytes()), gnuplot_text(all_bytes())})
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

TEST(QuotedText, ACommentDoesNotEndInABackslashEvenBeforeBlanks) {
  EXPECT_EQ(comment_text("a\\"), "a\\.");
  EXPECT_EQ(comment_text("a\\ \t"), "a\\ \t.");
  EXPECT_EQ(comment_text("a?\?/"), "a?\?/.");
  EXPECT_EQ(comment_text("a\\b"), "a\\b");
  EXPECT_EQ(comment_text(""), "");
}

TEST(QuotedText, AStringOfCppHasItsQuotesAndBytes) {
  EXPECT_EQ(cpp_string("a\"b\\c"), R"("a\"b\\c")");
  EXPECT_EQ(cpp_string("é"), "\"é\"");
  EXPECT_EQ(cpp_string("?\?/"), R"("?\?/")");
  // An octal escape ends after three digits: the 7 is a character of its own.
  EXPECT_EQ(cpp_string("\n7"), R"("\0127")");
}

TEST(QuotedText, HtmlHasNoMarkupOfTheUsers) {
  EXPECT_EQ(html_text("<b a='1' c=\"2\">&\r\n"),
            "&lt;b a=&#39;1&#39; c=&quot;2&quot;&gt;&amp;&lt;U+000D&gt;\n");
}

TEST(QuotedText, ATitleOfGnuplotEndsWhereItsQuotesEnd) {
  EXPECT_EQ(gnuplot_text("it's `x`\n\"y\""), "'it''s `x`<U+000A>\"y\"'");
}

TEST(QuotedText, APathOfGnuplotKeepsItsBytes) {
  EXPECT_EQ(gnuplot_path("out put/it's.svg"), "'out put/it''s.svg'");
  EXPECT_EQ(gnuplot_path("a\n`b`.svg"), R"("a\012\140b\140.svg")");
}

}  // namespace
}  // namespace hamgen
