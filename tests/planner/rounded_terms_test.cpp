#include "generator/program/rounded_terms.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hamgen {

namespace {

// In the order of a step: x first, then what it is made into, then what is subtracted.
Expression symbol(const std::string& name) {
  const int rank = name == "x" ? 0 : name.starts_with("n") ? 1 : 2;
  return Expression::symbol(name, rank);
}

// What is named n1, n2 and so on.
struct Names {
  std::vector<std::string> texts;
  NameInTerm name() {
    return [this](TermRole /*role*/, const Expression& value) {
      texts.push_back(to_text(value));
      return symbol("n" + std::to_string(texts.size()));
    };
  }
};

using Texts = std::vector<std::string>;

TEST(RoundedTerms, AProductComesWithItsErrorOrWithout) {
  Names names;
  const RoundedTerm with = rounded_product(names.name(), symbol("w"), symbol("x"));
  const RoundedTerm without = rounded_product(names.name(), symbol("w"), symbol("x"), false);
  EXPECT_EQ(names.texts, (Texts{"x*w", "product_error(w, x)", "x*w"}));
  EXPECT_EQ(to_text(with.large + with.small), "n1 + n2");
  EXPECT_EQ(to_text(without.large), "n3");
  EXPECT_TRUE(without.small.is_zero());
}

// n1 + n2 is s x, and x - n1 has no error.
TEST(RoundedTerms, TwoSharesAreTheWhole) {
  Names names;
  const Expression s = symbol("s");
  const Expression lost = symbol("lost");
  const RoundedTerm product = rounded_share(names.name(), s, symbol("x"), s * lost, false);
  Names again;
  const RoundedTerm left = rounded_share(again.name(), s, symbol("x"), lost - s * lost, true);
  EXPECT_EQ(names.texts, (Texts{"x*s", "product_error(s, x)"}));
  EXPECT_EQ(again.texts, (Texts{"x*s", "product_error(s, x)", "x - n1"}));
  EXPECT_EQ(to_text(product.small + left.small), "lost");
  EXPECT_EQ(to_text(product.large), "n1");
  EXPECT_EQ(to_text(left.large), "n3");
}

TEST(RoundedTerms, OfNumbersThatCancelTheLastDifferenceHasNoError) {
  const std::vector<Expression> numbers{symbol("a"), symbol("b")};
  const auto texts = [&](Errors errors, const char* small) {
    Names names;
    const RoundedTerm term = rounded_difference(names.name(), symbol("x"), numbers, errors);
    EXPECT_EQ(to_text(term.small), small);
    return names.texts;
  };
  EXPECT_EQ(texts(Errors::none, "0"), (Texts{"x - a", "n1 - b"}));
  EXPECT_EQ(texts(Errors::of_all_but_the_last, "n2"),
            (Texts{"x - a", "difference_error(x, a)", "n1 - b"}));
  EXPECT_EQ(texts(Errors::of_all, "n2 + n4"),
            (Texts{"x - a", "difference_error(x, a)", "n1 - b", "difference_error(n1, b)"}));
}

}  // namespace

}  // namespace hamgen
