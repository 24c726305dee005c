// Formulas in the sentences of findings.
#include "app/output/math_text.hpp"

#include <gtest/gtest.h>

#include <regex>

#include "generator/verify/verdict.hpp"
#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

using app::math_line;
using app::math_prose;

// What is shown, without the elements: letters as they follow each other.
std::string shown(const std::string& markup) {
  return std::regex_replace(markup, std::regex("<[^>]*>|&#x2062;"), "");
}

TEST(MathText, SetsWhatIsMarkedAndLeavesTheRest) {
  EXPECT_EQ(math_prose("3 < 4 entries of `M`"), "3 &lt; 4 entries of <math><mi>M</mi></math>");
  EXPECT_EQ(math_prose("`n = 1`"), "<math><mi>n</mi><mo>=</mo><mn>1</mn></math>");
}

TEST(MathText, HasScriptsWhereTheyBelong) {
  EXPECT_EQ(math_line("A+^T"),
            "<msubsup><mrow><mi>A</mi></mrow><mrow><mo>+</mo></mrow>"
            "<mrow><mi mathvariant='normal'>T</mi></mrow></msubsup>");
  EXPECT_EQ(math_line("b_i"), "<msub><mrow><mi>b</mi></mrow><mrow><mi>i</mi></mrow></msub>");
  EXPECT_EQ(math_line("C0"), "<msub><mi>C</mi><mrow><mn>0</mn></mrow></msub>");
  EXPECT_EQ(math_line("M^-1"),
            "<msup><mrow><mi>M</mi></mrow><mrow><mo form='prefix'>−</mo><mn>1</mn></mrow></msup>");
  EXPECT_EQ(shown(math_line("a_(s+1-i)(s+1-j) + a_ij = b_j")), "as+1−i,s+1−j+aij=bj");
}

// A sign between operands, in front of one, and of a factor.
TEST(MathText, TellsSigns) {
  EXPECT_EQ(math_line("-C"), "<mo form='prefix'>−</mo><mi>C</mi>");
  EXPECT_EQ(math_line("A - C"), "<mi>A</mi><mo>−</mo><mi>C</mi>");
  EXPECT_EQ(shown(math_line("h^9 -2.5e-05 f")), "h9(−2.5×10−5)f");
}

TEST(MathText, KnowsItsWords) {
  EXPECT_EQ(shown(math_line("f = J grad H")), "f=J∇H");
  EXPECT_EQ(shown(math_line("theta = 2 atan(h w/2)")), "θ=2atan(hω/2)");
  EXPECT_EQ(shown(math_line("f''(f,f)/24 + ...")), "f′′(f,f)/24+…");
}

// Half a formula is no reason to fail.
TEST(MathText, TakesAnyText) {
  for (const std::string text :
       {"", "`", "`(", "`{a", "`f'", "`a_", "`a^(", "`1e", "`|x", "`)", "`%`"})
    EXPECT_NO_THROW((void)math_prose(text)) << text;
}

// Each of them is marked from its beginning to its end, and nothing of it is seen on a terminal.
TEST(MathText, IsOfTheFindingsOfEveryKindOfMethod) {
  for (const std::string scheme :
       {"implicit-midpoint", "stormer-verlet", "yoshida-4", "gauss-4", "rk4"}) {
    const Result outcome =
        hamgen({"verify", HAMGEN_SOURCE_DIR "/hamiltonians/kepler.ham", "--scheme", scheme});
    EXPECT_TRUE(contains(outcome.out, "= J grad H") || contains(outcome.out, "{I, H} = 0"));
    EXPECT_FALSE(contains(outcome.out, "`")) << outcome.out;
  }
  const Finding finding{"symmetric", Verdict::proved, "`C(-h) = -C(h)`: its own adjoint"};
  EXPECT_EQ(finding.plain(), "C(-h) = -C(h): its own adjoint");
}

}  // namespace
}  // namespace hamgen::app_test
