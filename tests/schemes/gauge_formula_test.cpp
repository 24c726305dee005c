// alpha, beta, gamma and C as they are read before there is a model.
#include <gtest/gtest.h>

#include "generator/base/diagnostic.hpp"
#include "generator/schemes/read_gauge.hpp"

namespace hamgen {
namespace {

using Names = std::set<std::string>;

TEST(GaugeFormula, KnowsItsFormAndWhatItNames) {
  const AlphaFormula one = AlphaFormula::read("1/2 + a*h");
  EXPECT_TRUE(one.is_uniform());
  EXPECT_EQ(one.names(), (Names{"a", "h"}));
  const BetaFormula list = BetaFormula::read("[b, m[2], sin(b)]");
  EXPECT_FALSE(list.is_uniform());
  EXPECT_FALSE(list.is_matrix);
  EXPECT_EQ(list.rows.at(0).size(), 3U);
  EXPECT_EQ(list.names(), (Names{"b", "m"}));
  const GammaFormula matrix = GammaFormula::read("[[a, 0], [0, gamma]]");
  EXPECT_TRUE(matrix.is_matrix);
  EXPECT_FALSE(matrix.is_uniform());
  EXPECT_EQ(matrix.names(), (Names{"a", "gamma"}));
}

// A function of more arguments has commas, and names that only begin alike are others.
TEST(GaugeFormula, TakesNoPartOfATextForAName) {
  const BetaFormula formula = BetaFormula::read("atan2(beta_1, h)");
  EXPECT_TRUE(formula.is_uniform());
  EXPECT_EQ(formula.names(), (Names{"beta_1", "h"}));
}

TEST(GaugeFormula, OfNothingIsTheMidpointRule) {
  const auto text = [](const GaugeFormula& formula) { return formula.rows.at(0).at(0).text; };
  EXPECT_EQ(text(AlphaFormula::read("")), "1/2");
  EXPECT_EQ(text(BetaFormula::read("")), "0");
  EXPECT_EQ(text(GammaFormula::read("")), "0");
}

TEST(GaugeFormula, IsRefusedWhereItIsGivenIfItIsNone) {
  EXPECT_THROW(static_cast<void>(AlphaFormula::read("1/")), ModelError);
  EXPECT_THROW(static_cast<void>(BetaFormula::read("a,,b")), ModelError);
  EXPECT_THROW(static_cast<void>(BetaFormula::read("[a, b")), UsageError);
  EXPECT_THROW(static_cast<void>(GaugeWish::read("[a, b]")), UsageError);
  EXPECT_THROW(static_cast<void>(GaugeWish::read("exact")), UsageError);
  EXPECT_TRUE(GaugeWish::read("locally-exact").locally_exact);
  EXPECT_TRUE(GaugeWish::read("[[0, 1], [2, 0]]").matrix.has_value());
}

}  // namespace
}  // namespace hamgen
