// A list of quantities is what was put into it, however it keeps them.
#include "generator/mechanics/quantity_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace hamgen {
namespace {

Quantity named(const std::string& name, const std::string& comment = "") {
  return {name, "m", comment, 0};
}

TEST(QuantityList, KeepsAnArrayAsOne) {
  QuantityList list;
  list.push_back(named("x"));
  list.append(named("q", "angles"), -1, 1'000'000);
  list.push_back(named("q[999999]", "angles"));
  list.push_back(named("q[1000000]", "others"));
  list.push_back(named("p[3]"));
  list.push_back(named("p[5]"));
  EXPECT_EQ(list.size(), 1'000'005u);
  EXPECT_EQ(list.runs().size(), 5u);
  EXPECT_EQ(list.name(0), "x");
  EXPECT_EQ(list.name(1), "q[-1]");
  EXPECT_EQ(list[1'000'001].name, "q[999999]");
  EXPECT_EQ(list[1'000'002].comment, "others");
  EXPECT_EQ(list[1'000'003].unit, "m");
  EXPECT_EQ(list.back().name, "p[5]");
}

TEST(QuantityList, IsARangeOfItsElements) {
  const std::vector<Quantity> elements = {named("a"), named("q[1]"), named("q[2]"), named("b")};
  const QuantityList list(elements);
  EXPECT_EQ(list.end() - list.begin(), 4);
  EXPECT_EQ(std::ranges::find(list, "q[2]", &Quantity::name) - list.begin(), 2);
  std::vector<std::string> names;
  for (const Quantity& each : list.elements()) names.push_back(each.name);
  EXPECT_EQ(names, (std::vector<std::string>{"a", "q[1]", "q[2]", "b"}));
}

TEST(QuantityList, NamesHaveNoValues) {
  std::vector<Quantity> masses = {named("m[1]"), named("m[2]")};
  masses[1].value = 2;
  EXPECT_EQ(QuantityList(masses).runs().size(), 2u);
  EXPECT_EQ(names_of(masses).runs().size(), 1u);
}

}  // namespace
}  // namespace hamgen
