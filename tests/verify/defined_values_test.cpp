// Values that are computed twice are found, by other names and with the other sign, as a search
// through all of them finds them.
#include "generator/verify/defined_values.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

#include "generator/mechanics/mechanics.hpp"

namespace hamgen {
namespace {

Expression named(const std::string& name) { return Expression::symbol(name, kRankOfTemporary); }

const Expression kX = Expression::symbol("x");
const Expression kY = Expression::symbol("y");

TEST(DefinedValues, AreFoundByTheirValue) {
  DefinedValues values;
  values.add("a", kX * kY);
  values.add("b", kX + kY);
  values.add("c", kX * kY);
  EXPECT_EQ(values.computed_as(kX * kY), 2U);
  EXPECT_EQ(values.computed_as(kX + kY), 1U);
  EXPECT_FALSE(values.computed_as(kX - kY));
  EXPECT_EQ(values.place("b"), 1U);
  EXPECT_FALSE(values.place("x"));
}

TEST(DefinedValues, AreFoundByOtherNamesOfEqualNumbers) {
  DefinedValues values;
  values.add("a", kX + kY);
  values.add("b", kX + kY);
  values.add("c", named("a") * kX);
  values.add("d", -kX - kY);
  EXPECT_EQ(values.computed_as(named("b") * kX), 2U);
  EXPECT_EQ(values.computed_as(-named("d") * kX), 2U);
  EXPECT_FALSE(values.computed_as(named("d") * kX));
}

// A number that has lost something is no longer equal to one that has not, nor is what is made of
// it.
TEST(DefinedValues, AreNotFoundByWhatTheyWere) {
  DefinedValues values;
  values.add("a", kX * kY);
  values.add("b", kX * kY);
  values.add("c", named("b") * kX);
  EXPECT_EQ(values.computed_as(named("a") * kX), 2U);
  values.change(1, kX * kY - Expression::symbol("lost"));
  EXPECT_EQ(values.computed_as(kX * kY), 0U);
  EXPECT_FALSE(values.computed_as(named("a") * kX));
  EXPECT_EQ(values.computed_as(named("b") * kX), 2U);
  values.change(0, kX * kY - Expression::symbol("lost"));
  EXPECT_EQ(values.computed_as(named("a") * kX), 2U);
  EXPECT_FALSE(values.computed_as(kX * kY));
}

// All of them in turn, as often as something is asked.
std::optional<std::size_t> searched(const std::vector<Statement>& all, const Expression& exact) {
  for (std::size_t i = all.size(); i-- > 0;) {
    if (all[i].value == exact) return i;
  }
  Substitution same;
  std::vector<Expression> values;
  for (const Statement& s : all) {
    values.push_back(substitute(s.value, same));
    for (std::size_t j = 0; j + 1 < values.size(); ++j) {
      if (values[j] != values.back() && values[j] != -values.back()) continue;
      // The first that is equal counts before the first of the other sign.
      const auto equal = std::find(values.begin(), values.end() - 1, values.back());
      const bool is_equal = equal != values.end() - 1;
      const std::size_t first = is_equal ? static_cast<std::size_t>(equal - values.begin()) : j;
      same.emplace(s.name, is_equal ? named(all[first].name) : -named(all[first].name));
      break;
    }
  }
  const Expression wanted = substitute(exact, same);
  for (std::size_t i = values.size(); i-- > 0;) {
    if (values[i] == wanted) return i;
  }
  return {};
}

TEST(DefinedValues, AreFoundAsASearchThroughAllOfThemFindsThem) {
  std::mt19937 random(20261126);  // NOLINT: the same in every run
  const auto below = [&random](std::size_t n) { return random() % n; };
  int found = 0;
  for (int round = 0; round < 60; ++round) {
    DefinedValues values;
    std::vector<Expression> numbers = {kX, kY, Expression(2)};
    const auto product_or_difference = [&] {
      const Expression a = numbers[below(numbers.size())];
      const Expression b = numbers[below(numbers.size())];
      return below(2) == 0 ? a * b : a - b;
    };
    for (int i = 0; i < 25; ++i) {
      const std::string name = "d" + std::to_string(i);
      const Expression value = product_or_difference();
      if (value.is_number() || value.kind() == Kind::symbol) continue;
      values.add(name, value);
      numbers.push_back(named(name));
      const Expression asked = product_or_difference();
      const auto place = values.computed_as(asked);
      EXPECT_EQ(place, searched(values.all(), asked)) << round << " " << i;
      found += place ? 1 : 0;
      if (place && below(4) == 0)
        values.change(*place, values.all()[*place].value - Expression::symbol("lost" + name));
    }
  }
  EXPECT_GT(found, 50);
}

}  // namespace
}  // namespace hamgen
