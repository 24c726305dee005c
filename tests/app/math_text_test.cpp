// Formulas in the sentences of findings.
#include "app/output/math_text.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "app/output/math_markup.hpp"
#include "app/output/math_notation.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/verify/verdict.hpp"
#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

using app::math_prose;

std::string math_line(std::string_view text) { return app::line_markup(app::read_notation(text)); }

// What is shown, without the elements: letters as they follow each other.
std::string shown(const std::string& markup) {
  return std::regex_replace(markup, std::regex("<[^>]*>|&#x2062;|&#x2061;"), "");
}

TEST(MathText, SetsWhatIsMarkedAndLeavesTheRest) {
  EXPECT_EQ(math_prose("3 < 4 entries of `M`"), "3 &lt; 4 entries of <math><mi>M</mi></math>");
  EXPECT_EQ(math_prose("`n = 1`"), "<math><mi>n</mi><mo>=</mo><mn>1</mn></math>");
}

TEST(MathText, HasScriptsWhereTheyBelong) {
  EXPECT_EQ(math_line("A+^T"),
            "<msubsup><mi>A</mi><mrow><mo lspace='0' rspace='0'>+</mo></mrow>"
            "<mrow><mi mathvariant='normal'>T</mi></mrow></msubsup>");
  EXPECT_EQ(math_line("b_i"), "<msub><mi>b</mi><mrow><mi>i</mi></mrow></msub>");
  EXPECT_EQ(math_line("C0"), "<msub><mi>C</mi><mrow><mn>0</mn></mrow></msub>");
  EXPECT_EQ(math_line("M^-1"),
            "<msup><mrow><mi>M</mi></mrow><mrow><mo form='prefix'>−</mo><mn>1</mn></mrow></msup>");
  EXPECT_EQ(shown(math_line("a_(s+1-i)(s+1-j) + a_ij = b_j")), "as+1−i,s+1−j+aij=bj");
  EXPECT_EQ(shown(math_line("f^(4)(f,f)/4!")), "f(4)(f,f)/4!");
}

// A sign between operands, in front of one, and of a factor.
TEST(MathText, TellsSigns) {
  EXPECT_EQ(math_line("-C"), "<mo form='prefix'>−</mo><mi>C</mi>");
  EXPECT_EQ(math_line("A - C"), "<mi>A</mi><mo form='infix'>−</mo><mi>C</mi>");
  EXPECT_EQ(shown(math_line("h^9 -2.5e-05 f")), "h9(−2.5·10−5)f");
}

TEST(MathText, KnowsItsWords) {
  EXPECT_EQ(shown(math_line("f = J grad H")), "f=J∇H");
  EXPECT_EQ(shown(math_line("theta = 2 atan(h omega/2)")), "θ=2atan(hω/2)");
  EXPECT_EQ(shown(math_line("f''(f,f)/24 + ...")), "f′′(f,f)/24+…");
}

// What a finding quotes of the model looks as it does in the rest of the page: one formula, from
// the expression or from its text.
TEST(MathText, AnExpressionLooksTheSameFromItsText) {
  const std::filesystem::path models = std::filesystem::path(HAMGEN_SOURCE_DIR) / "hamiltonians";
  std::size_t compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(models)) {
    const Mechanics mechanics = derive(read_model(read_source(entry.path().string())));
    if (mechanics.keeps_sums()) continue;
    std::vector<Expression> expressions = mechanics.gradient;
    expressions.push_back(mechanics.energy);
    for (const auto& [place, value] : mechanics.hessian) expressions.push_back(value);
    for (const Expression& expression : expressions) {
      EXPECT_EQ(math_line(to_text(expression)), app::line_markup(app::math_formula(expression)))
          << to_text(expression);
      ++compared;
    }
  }
  EXPECT_GT(compared, 300U) << "the models were not found";
}

// Half a formula is no reason to fail.
TEST(MathText, TakesAnyText) {
  for (const std::string text :
       {"", "`", "`(", "`{a", "`f'", "`a_", "`a^(", "`1e", "`|x", "`)", "`%`", "`a_(b`", "`x[`",
        "`{}}`", "`= =`", "`a - - b`", "`((((`", "`|a| |b`"})
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
