// The parentheses of expressions in the emitted code: those that are needed, and no others.
#include "generator/formats/print_expression.hpp"

#include <gtest/gtest.h>

#include "generator/formats/cpp_dialect.hpp"

namespace hamgen::emitted_test {
namespace {

TEST(PrintedExpression, HasTheParenthesesThatItNeeds) {
  const CppDialect dialect(find_scalar("double"), 0, false);
  const ExpressionPrinter print(dialect, [](const std::string& name) { return name; });
  const Expression a = Expression::symbol("a", 0);
  const Expression b = Expression::symbol("b", 1);
  const Expression c = Expression::symbol("c", 2);
  EXPECT_EQ(print(a - b - c), "a - b - c");
  EXPECT_EQ(print(a - (b + c)), "a - b - c");
  EXPECT_EQ(print(-(b + c)), "-(b + c)");
  EXPECT_EQ(print(a * (b + c)), "a * (b + c)");
  EXPECT_EQ(print(a / (b * c)), "a / (b * c)");
  EXPECT_EQ(print(a / (b + c)), "a / (b + c)");
  EXPECT_EQ(print((a + b) / c), "(a + b) / c");
  EXPECT_EQ(print(a * b / c), "a * b / c");
  EXPECT_EQ(print(a - b * c), "a - b * c");
}

}  // namespace
}  // namespace hamgen::emitted_test
