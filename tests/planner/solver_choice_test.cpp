// What is asked of the solver, read where it is asked.
#include <gtest/gtest.h>

#include "generator/base/diagnostic.hpp"
#include "generator/base/fixed_blocks.hpp"
#include "generator/solvers/all_solvers.hpp"

namespace hamgen {
namespace {

TEST(SolverChoice, IsWhatItsTextSays) {
  using Kind = SolverWish::Kind;
  EXPECT_EQ(*SolverChoice(), (SolverWish{Kind::cheapest, 0}));
  EXPECT_EQ(*SolverChoice("newton"), (SolverWish{Kind::newton, 0}));
  EXPECT_EQ(*SolverChoice("fixed-point"), (SolverWish{Kind::fixed_point, 0}));
  EXPECT_EQ(*SolverChoice("sweeps:17"), (SolverWish{Kind::sweeps, 17}));
  EXPECT_EQ(SolverChoice("sweeps:17").text(), "sweeps:17");
}

TEST(SolverChoice, OfTheWholeListIsRead) {
  for (const NamedSolver& solver : all_solvers()) {
    std::string text(solver.name);
    if (text.ends_with(":K")) text.back() = '4';
    EXPECT_NE(SolverChoice(text)->kind, SolverWish::Kind::cheapest) << text;
  }
}

TEST(SolverChoice, EndsAFixedPointByARuleThatLanesHaveToo) {
  for (const NamedSolver& solver : all_solvers()) {
    std::string text(solver.name);
    if (text.ends_with(":K")) text.back() = '4';
    const std::string_view rule = SolverChoice(text)->rule;
    const std::string_view name = rule.substr(0, rule.find('<'));
    EXPECT_TRUE(is_defined(cpp_blocks(), name)) << text;
    EXPECT_TRUE(is_defined(lane_blocks(), name)) << text;
  }
  EXPECT_FALSE(is_defined(lane_blocks(), "StagnationRule"));
}

TEST(SolverChoice, OfAnotherNameOrNumberIsRefusedWhereItIsGiven) {
  for (const char* text : {"Newton", "newton:3", "sweeps", "sweeps:", "sweeps:-1", "sweeps:1001",
                           "sweeps:3x", "fixed-point:2", " newton"})
    EXPECT_THROW(static_cast<void>(SolverChoice(text)), UsageError) << text;
}

}  // namespace
}  // namespace hamgen
