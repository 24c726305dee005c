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

// What is said of a Hamiltonian that is no mistake to the reader: its first line.
std::string said_of(const std::string& hamiltonian) {
  try {
    static_cast<void>(derived("coordinate q\nmomentum p\nH = " + hamiltonian + "\n"));
  } catch (const ModelError& error) {
    const std::string text = error.what();
    return text.substr(0, text.find('\n'));
  }
  return "";
}

// acosh(0) is not real wherever the 0 comes from.
TEST(Derivation, ConstantsThatTurnComplexAfterCancellingAreMistakesWithAPlace) {
  const std::vector<std::pair<std::string, std::string>> mistakes = {
      {"p^2 + acosh(p - p)*q", "11: error: acosh(0) is not a real number"},
      {"p^2 + acosh(0*q)", "11: error: acosh(0) is not a real number"},
      {"p^2 + q*log(q - q - 1)", "13: error: log(-1) is not a real number"},
      {"p^2 + q*log(-1*1^q)", "13: error: log(-1) is not a real number"},
      {"p^2 + asin(p - p + 2)*q", "11: error: asin(2) is not a real number"},
      {"p^2 + q*(q - q - 2)^(1/3)", "13: error: (-2)^(1/3) is not a real number"},
      {"p^2 + q*sqrt(q - q - 2)", "13: error: sqrt(-2) is not a real number"},
      {"p^2 + q*atan2(q - q, q - q)", "13: error: atan2(0, 0) is not a real number"}};
  for (const auto& [hamiltonian, said] : mistakes)
    EXPECT_EQ(said_of(hamiltonian), "m.ham:3:" + said) << hamiltonian;
  for (const char* fine : {"p^2 + acosh(p - p + 1)*q", "p^2 + q*sqrt(2)^sqrt(3)",
                           "p^2 + q*(q - q - 2)^3", "p^2 + q*log(2 + q - q)"})
    EXPECT_EQ(said_of(fine), "") << fine;
}

// d|u| = u u'/|u| and d^2|u| = u u''/|u|, for u that is real only where H has a value.
TEST(Derivation, OfAnAbsoluteValueKnowsThatItsArgumentIsReal) {
  for (const char* u : {"log(q)", "acosh(2*q)", "asin(q)", "atanh(q)", "asinh(q)",
                        "(1 - sqrt(q^2 + p^2))", "(q - sqrt(p^2 + 1))", "(q - log(p))",
                        "(-exp(log(q)*sqrt(p)))", "exp(asin(q)*atanh(p))", "(-sqrt(q)^log(p))"}) {
    const std::string text = u;
    const Mechanics of_abs = derived("coordinate q\nmomentum p\nH = p^2 + abs(" + text + ")\n");
    const Mechanics plain = derived("coordinate q\nmomentum p\nH = " + text + "\n");
    const Values at{{"q", Rational(9, 10)}, {"p", Rational(3, 5)}};
    const Rational value = evaluate(plain.energy, at).value();
    const Rational sign(value < 0 ? -1 : 1);
    const Rational p_squared(9, 25);
    EXPECT_NEAR(to_double(*evaluate(of_abs.energy, at)), to_double(sign * value + p_squared), 1e-14)
        << u;
    for (std::size_t i = 0; i < 2; ++i) {
      const double own = i == 1 ? 2 * 0.6 : 0;
      EXPECT_NEAR(to_double(*evaluate(of_abs.gradient[i], at)),
                  own + to_double(sign * *evaluate(plain.gradient[i], at)), 1e-13)
          << u;
    }
    for (const auto& [place, entry] : plain.hessian) {
      const double own = place == std::pair(1, 1) ? 2 : 0;
      EXPECT_NEAR(to_double(*evaluate(of_abs.hessian.at(place), at)),
                  own + to_double(sign * *evaluate(entry, at)), 1e-12)
          << u;
    }
  }
}

// 100^8 terms on a line.
TEST(Derivation, CountsTheTermsOfNestedRanges) {
  std::string ranges;
  for (const char index : std::string("abcdefgs")) ranges += fmt::format("{} = 1..100, ", index);
  EXPECT_EQ(said_of("p^2/2 + sum(" + ranges + "q^2/(a + b + c + d + e + f + g + s))"),
            "m.ham:3:113: error: this is written out more than 1000000 times");
  EXPECT_EQ(said_of("p^2/2 + sum(a = 1..100, b = 1..100, q^2/(a + b))"), "");
}

// In loops H may have any number of elements; what is observed beside it has each of its terms.
TEST(Derive, RefusesASumBesideHThatNoCompilerWouldTake) {
  const auto derived = [](int elements) {
    return derive(
        read_model(make_source("m.ham", "size N = " + std::to_string(elements) +
                                            "\ncoordinate q[1..N]\nmomentum p[1..N]\n"
                                            "H = sum(i=1..N, p[i]^2/2 + q[i]^4)\n"
                                            "invariant P = 3*(1 + sum(i=1..N, p[i]*q[i]))\n")),
        true, 24);
  };
  EXPECT_EQ(derived(3000).invariants.size(), 1U);
  try {
    (void)derived(30001);
    ADD_FAILURE();
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("more than 30000 terms"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("m.ham:5:"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace hamgen
