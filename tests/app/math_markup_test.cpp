// Formulas of pages: MathML from an expression is that of its text, without reading any text.
#include "app/output/math_markup.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"

namespace hamgen::app_test {
namespace {

using app::accented_markup;
using app::math_formula;
using app::math_pieces;
using app::math_variable;

std::string math_markup(const Expression& expression) {
  return app::math_markup(math_formula(expression));
}
std::string math_markup(const NodePtr& node) { return app::math_markup(math_formula(node)); }

Expression symbol(const std::string& name) { return Expression::symbol(name); }

const std::string times = "<mo>&#x2062;</mo><mspace width='0.14em'/>";
const std::string minus = "<mo form='prefix'>−</mo>";
const std::string open = "<mrow><mo stretchy='false'>(</mo>";
const std::string close = "<mo stretchy='false'>)</mo></mrow>";

TEST(MathMarkup, TheSignStandsBeforeTheBarAndNumbersComeFirst) {
  EXPECT_EQ(math_markup(Expression(Rational(-3, 2)) * symbol("eps") / symbol("q1")),
            minus + "<mfrac><mrow><mn>3</mn>" + times + "<mi>ε</mi></mrow><mrow><mn>2</mn>" +
                times + "<msub><mi>q</mi><mrow><mn>1</mn></mrow></msub></mrow></mfrac>");
}

TEST(MathMarkup, APowerStandsAboveTheSubscriptAndAfterTheNameOfAFunction) {
  EXPECT_EQ(math_markup(Expression::power(symbol("q[3]"), 2)),
            "<msubsup><mi>q</mi><mrow><mn>3</mn></mrow><mrow><mn>2</mn></mrow></msubsup>");
  EXPECT_EQ(math_markup(Expression::power(Expression::apply("sin", {symbol("q")}), 2)),
            "<msup><mi>sin</mi><mrow><mn>2</mn></mrow></msup><mo>&#x2061;</mo>" + open +
                "<mi>q</mi>" + close);
}

TEST(MathMarkup, ARootIsARootAndAFractionInAnExponentIsWrittenOnOneLine) {
  EXPECT_EQ(math_markup(square_root(symbol("q"))), "<msqrt><mrow><mi>q</mi></mrow></msqrt>");
  EXPECT_EQ(math_markup(Expression::power(symbol("q"), Rational(1, 3))),
            "<msup><mrow><mi>q</mi></mrow>"
            "<mrow><mn>1</mn><mo lspace='0' rspace='0'>/</mo><mn>3</mn></mrow></msup>");
}

std::string read_markup(const std::string& text) {
  return math_markup(read_expression("test", text, {"a", "b", "c", "d", "q"}));
}

// Quotients of quotients come under one bar, and what is inside a fraction has slashes.
TEST(MathMarkup, NoFractionHasABarInsideAnother) {
  EXPECT_EQ(read_markup("a/b/c"),
            "<mfrac><mrow><mi>a</mi></mrow><mrow><mi>b</mi>" + times + "<mi>c</mi></mrow></mfrac>");
  const std::string nested = read_markup("(a/b + c)/(d + a/(b*c))");
  EXPECT_EQ(nested.find("<mfrac"), nested.rfind("<mfrac")) << nested;
  EXPECT_EQ(read_markup("1/(a/b*c)"),
            "<mfrac><mrow><mn>1</mn></mrow><mrow><mi>a</mi>" + times +
                "<mi>c</mi><mo lspace='0' rspace='0'>/</mo><mi>b</mi></mrow></mfrac>");
}

// What a sign or a slash stands before is in parentheses where it must be.
TEST(MathMarkup, ParenthesesStandWhereTheMeaningNeedsThem) {
  const std::string sum = "<mi>b</mi><mo form='infix'>+</mo><mi>c</mi>";
  EXPECT_EQ(read_markup("a - (b + c)"), "<mi>a</mi><mo form='infix'>−</mo>" + open + sum + close);
  EXPECT_EQ(read_markup("a*(b + c)"), "<mi>a</mi>" + times + open + sum + close);
  EXPECT_EQ(read_markup("(b + c)^2"),
            "<msup><mrow>" + open + sum + close + "</mrow><mrow><mn>2</mn></mrow></msup>");
  EXPECT_EQ(read_markup("(-a)^2"), "<msup><mrow>" + open + minus + "<mi>a</mi>" + close +
                                       "</mrow><mrow><mn>2</mn></mrow></msup>");
  EXPECT_EQ(read_markup("-(b - c)"), "<mi>c</mi><mo form='infix'>−</mo><mi>b</mi>");
  EXPECT_EQ(read_markup("q/(1/(a*(b/c)))").find("<mfrac"), 0U);
}

TEST(MathMarkup, NamesHaveTheirSubscripts) {
  const auto shown = [](const std::string& name) { return math_markup(symbol(name)); };
  EXPECT_EQ(shown("px"), "<msub><mi>p</mi><mrow><mi>x</mi></mrow></msub>");
  EXPECT_EQ(shown("rc"), "<msub><mi>r</mi><mrow><mi>c</mi></mrow></msub>");
  EXPECT_EQ(shown("ptheta1"), "<msub><mi>p</mi><mrow><mi>θ</mi><mn>1</mn></mrow></msub>");
  EXPECT_EQ(shown("v_max"), "<msub><mi>v</mi><mrow><mi>max</mi></mrow></msub>");
  EXPECT_EQ(shown("mass"), "<mi>mass</mi>");
  EXPECT_EQ(shown("GM"), "<mi>GM</mi>");
  EXPECT_EQ(shown("mu"), "<mi>μ</mi>");
  EXPECT_EQ(
      accented_markup(math_variable("q[1]"), "˙"),
      "<msub><mover accent='true'><mi>q</mi><mo>˙</mo></mover><mrow><mn>1</mn></mrow></msub>");
}

TEST(MathMarkup, ALineMayEndBetweenTheTermsOfASum) {
  const auto pieces = [](const std::string& text) {
    return math_pieces(math_formula(read_expression("test", text, {"a", "b", "c", "d"}))).size();
  };
  EXPECT_EQ(pieces("a + b - c*d"), 3U);
  EXPECT_EQ(pieces("a*b"), 1U);
  EXPECT_EQ(pieces("(a + b + c + d)/24"), 4U);
}

// Two ways to one formula: from the value, and through its text, the lexer and the parser.
TEST(MathMarkup, AnExpressionLooksAsItsTextWouldBeRead) {
  const std::filesystem::path models = std::filesystem::path(HAMGEN_SOURCE_DIR) / "hamiltonians";
  std::size_t compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(models)) {
    const Mechanics mechanics = derive(read_model(read_source(entry.path().string())));
    if (mechanics.keeps_sums()) continue;
    std::vector<std::string> names;
    for (const Quantity& variable : mechanics.variables) names.push_back(variable.name);
    for (const Quantity& parameter : mechanics.parameters) names.push_back(parameter.name);
    std::vector<Expression> expressions = mechanics.gradient;
    expressions.push_back(mechanics.energy);
    for (const auto& [place, value] : mechanics.hessian) expressions.push_back(value);
    for (const NamedExpression& invariant : mechanics.invariants)
      expressions.push_back(invariant.value);
    for (const Expression& expression : expressions) {
      const std::string text = to_text(expression);
      EXPECT_EQ(math_markup(expression), math_markup(read_expression("test", text, names))) << text;
      ++compared;
    }
  }
  EXPECT_GT(compared, 300U) << "the models were not found";
}

}  // namespace
}  // namespace hamgen::app_test
