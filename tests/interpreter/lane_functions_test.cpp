#include "generator/interpreter/lane_functions.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "generator/algebra/functions.hpp"

namespace hamgen::interpreter_test {
namespace {

// A function that is added to the language is one of stages in lanes, too.
TEST(LaneFunctions, AreThereForEveryFunctionOfTheLanguage) {
  for (const Function& row : all_functions()) {
    const double x = row.name == "acosh" ? 1.5 : 0.5;
    const double exact = row.numbers.real(x, 0.75);
    EXPECT_NEAR(lane_function(std::string(row.name))(x, 0.75), exact, 0x1p-52 * std::abs(exact))
        << row.name;
  }
  EXPECT_NEAR(lane_function("pow")(0.5, 0.75), std::pow(0.5, 0.75), 0x1p-52);
}

}  // namespace
}  // namespace hamgen::interpreter_test
