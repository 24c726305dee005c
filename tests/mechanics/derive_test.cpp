// Gradient and Hessian of models that are longer written out, or expanded, than they look.
#include "generator/mechanics/derive.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "generator/algebra/evaluate.hpp"
#include "generator/language/read_model.hpp"

namespace hamgen {
namespace {

Mechanics derived(const std::string& text) {
  return derive(read_model(make_source("m.ham", text)));
}

std::string logistic(int times) {
  std::string text = "coordinate q\nmomentum p\nlet x0 = q\n";
  for (int i = 1; i <= times; ++i) text += fmt::format("let x{0} = 3*x{1}*(1 - x{1})\n", i, i - 1);
  return text + fmt::format("H = p^2/2 + x{}\n", times);
}

// f_n' and f_n'' of the logistic map's iterates by the chain rule: f <- 3 f (1 - f).
TEST(Derivation, OfAGraphWithSharedPartsIsThatOfItsTree) {
  for (const int times : {2, 4, 8}) {
    const Mechanics mechanics = derived(logistic(times));
    double value = 0.25;
    double first = 1;
    double second = 0;
    for (int i = 0; i < times; ++i) {
      second = 3 * (1 - 2 * value) * second - 6 * first * first;
      first = 3 * (1 - 2 * value) * first;
      value = 3 * value * (1 - value);
    }
    const Values at{{"q", Rational(1, 4)}, {"p", 0}};
    const auto gradient = evaluate(mechanics.gradient[0], at);
    const auto curvature = evaluate(mechanics.hessian.at({0, 0}), at);
    ASSERT_TRUE(gradient && curvature) << times;
    // Each iterate rounds the three numbers a few times, and 3 (1 - 2 f) is at most 3 in size.
    const double rounding = 1e-15 * std::pow(3.0, times);
    EXPECT_NEAR(to_double(*gradient), first, rounding) << times;
    EXPECT_NEAR(to_double(*curvature), second, 10 * rounding) << times;
    EXPECT_EQ(mechanics.hessian.size(), 2u) << times;  // H_qq and H_pp
  }
}

// What expands to millions of terms is not expanded to see whether it is 0.
TEST(Derivation, DividesByPowersOfSumsWithoutExpandingThem) {
  const Mechanics mechanics = derived(
      "coordinate a, b, c\nmomentum pa, pb, pc\n"
      "H = (pa^2 + pb^2 + pc^2)/2 + 1/(1 + a + b + c + a*b)^300\n");
  EXPECT_EQ(mechanics.gradient.size(), 6u);
  EXPECT_THROW(
      static_cast<void>(derived("coordinate q\nmomentum p\nH = p^2/2 + 1/((q + 1)^2 - q^2 - 2*q "
                                "- 1)\n")),
      ModelError);
}

}  // namespace
}  // namespace hamgen
