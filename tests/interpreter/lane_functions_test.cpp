#include "generator/interpreter/lane_functions.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "generator/algebra/functions.hpp"
#include "generator/base/fixed_blocks.hpp"

namespace hamgen::interpreter_test {
namespace {

// Those that lanes have of their own, as they are emitted.
TEST(LaneFunctions, AreThereForEveryFunctionThatLanesHave) {
  for (const Function& row : all_functions()) {
    const std::string name(row.name);
    const auto own = lane_function(name);
    EXPECT_EQ(own != nullptr, is_defined(lane_blocks(), "lane_" + name)) << name;
    const double x = row.name == "acosh" ? 1.5 : 0.5;
    const double exact = row.numbers.real(x, 0.75);
    if (own == nullptr) continue;
    EXPECT_NEAR(own(x, 0.75), exact, 0x1p-52 * std::abs(exact)) << name;
  }
  EXPECT_EQ(lane_function("zeta"), nullptr);
  EXPECT_NEAR(lane_function("pow")(0.5, 0.75), std::pow(0.5, 0.75), 0x1p-52);
}

}  // namespace
}  // namespace hamgen::interpreter_test
