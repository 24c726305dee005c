// Expressions that are affine in the state: zero where they vanish at its unit points.
#include "generator/verify/affine.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "generator/pipeline.hpp"

namespace hamgen {
namespace {

using NameList = std::vector<std::string>;

struct Affine : ::testing::Test {
  const Expression x = Expression::symbol("x");
  const Expression y = Expression::symbol("y");
  const Expression h = Expression::symbol("h");
};

TEST_F(Affine, IsWhatHasNoProductsOfTheSymbols) {
  EXPECT_EQ(affine_symbols(x / (Expression(1) + h * h) - h * y), (NameList{"x", "y"}));
  EXPECT_EQ(affine_symbols(Expression(3)), NameList{});
  // Of a product one factor, and neither of a power or a function.
  EXPECT_EQ(affine_symbols(x * y), NameList{"x"});
  EXPECT_EQ(affine_symbols(x * x + y), NameList{"y"});
  EXPECT_EQ(affine_symbols(Expression::apply("sin", {x}) + y / x), NameList{"y"});
  EXPECT_EQ(affine_symbols((x + y) * (x - h)), NameList{"h"});
}

TEST_F(Affine, IsLookedAtWhereAllAreZeroAndWhereOneIsNot) {
  const std::vector<Expression> values = at_unit_points(h * x - y / h + Expression(7), {"x", "y"});
  EXPECT_EQ(values, (std::vector<Expression>{Expression(7), h + Expression(7),
                                             Expression(7) - Expression(1) / h}));
}

// Three oscillators with a name each, whose equations are solved by a matrix that is written out.
TEST_F(Affine, CoupledOscillatorsAreProved) {
  const SourceText source = make_source(
      "oscillators.ham",
      "coordinate x, y, u\nmomentum px, py, pu\nparameter k = 0.3\n"
      "H = (px^2 + py^2 + pu^2)/2 + x^2/2 + y^2 + 3*u^2/2 + k*(x - y)^2/2 + k*(y - u)^2/2\n");
  const Proof proof = verify_step(source, {});
  const auto program = std::ranges::find(proof, "program", &Finding::property);
  ASSERT_NE(program, proof.end());
  EXPECT_EQ(program->verdict, Verdict::proved) << program->detail;
}

}  // namespace
}  // namespace hamgen
