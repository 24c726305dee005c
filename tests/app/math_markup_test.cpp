// Formulas of pages: MathML from an expression is that of its text, without reading any text.
#include "app/output/math_markup.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"

namespace hamgen::app_test {
namespace {

using app::math_markup;

Expression symbol(const std::string& name) { return Expression::symbol(name); }

const std::string times = "<mo>&#x2062;</mo><mspace width='0.12em'/>";

TEST(MathMarkup, TheSignBelongsToTheFirstFactorAndNumbersComeFirst) {
  EXPECT_EQ(math_markup(Expression(Rational(-3, 2)) * symbol("eps") / symbol("q1")),
            "<mfrac><mrow><mfrac><mrow><mo>−</mo><mn>3</mn>" + times +
                "<mi>ε</mi></mrow><mrow><mn>2</mn></mrow></mfrac></mrow>"
                "<mrow><msub><mi>q</mi><mn>1</mn></msub></mrow></mfrac>");
}

TEST(MathMarkup, APowerStandsAboveTheSubscriptAndAfterTheNameOfAFunction) {
  EXPECT_EQ(math_markup(Expression::power(symbol("q[3]"), 2)),
            "<msubsup><mrow><mi>q</mi></mrow><mrow><mn>3</mn></mrow><mrow><mn>2</mn></mrow>"
            "</msubsup>");
  EXPECT_EQ(math_markup(Expression::power(Expression::apply("sin", {symbol("q")}), 2)),
            "<msup><mi>sin</mi><mrow><mn>2</mn></mrow></msup><mo>&#x2061;</mo>"
            "<mrow><mo>(</mo><mi>q</mi><mo>)</mo></mrow>");
}

TEST(MathMarkup, ARootIsARootAndAFractionInAnExponentIsWrittenOnOneLine) {
  EXPECT_EQ(math_markup(square_root(symbol("q"))), "<msqrt><mrow><mi>q</mi></mrow></msqrt>");
  EXPECT_EQ(math_markup(Expression::power(symbol("q"), Rational(1, 3))),
            "<msup><mrow><mi>q</mi></mrow>"
            "<mrow><mrow><mn>1</mn><mo>/</mo><mn>3</mn></mrow></mrow></msup>");
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
