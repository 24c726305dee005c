// Which records a routine changes alone.
#include "generator/program/alone.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "generator/base/source_text.hpp"
#include "generator/stages.hpp"

namespace hamgen {
namespace {

constexpr const char* kSwarm =
    "system swarm\nsize N = 30\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
    "H = sum(i = 1..N, p[i]^2/2 + (q[i+1] - q[i])^4/4)\n";

Program swarm(const std::string& scheme) {
  return run_stages(make_source("swarm.ham", kSwarm), {.scheme = scheme}).program;
}

// "dz rest start" of those that are.
std::string alone(const Program& code, const std::string& routine) {
  std::string names;
  for (const Argument& argument : code.routine(routine)->arguments) {
    if (argument.alone) names += (names.empty() ? "" : " ") + argument.name;
  }
  return names;
}

TEST(Alone, IsWhatAStepWritesAndRemembers) {
  EXPECT_EQ(alone(swarm("implicit-midpoint"), "solve"), "start dz rest");
  EXPECT_EQ(alone(swarm("implicit-midpoint"), "evaluate"), "start");
  EXPECT_EQ(alone(swarm("stormer-verlet"), "solve"), "start dz rest");
  EXPECT_EQ(alone(swarm("gauss-4"), "solve"), "start dz rest");
  EXPECT_EQ(alone(swarm("gauss-4"), "energy"), "");
}

TEST(Alone, IsNothingThatACallGivesTwice) {
  Program code = swarm("stormer-verlet");
  const std::size_t arguments = code.routine("solve")->arguments.size();
  // A step that leaves its increment where the carry is, and one that reads a part of its start.
  std::vector<Place> given;
  for (const Argument& argument : code.routine("solve")->arguments)
    given.push_back({argument.name});
  ASSERT_EQ(arguments, 7U);
  const auto with = [&](std::size_t place, const Place& what) {
    Program changed = code;
    std::vector<Place> other = given;
    other[place] = what;
    changed.routines.push_back(
        {.name = "another", .body = {{Call{.routine = "solve", .arguments = std::move(other)}}}});
    find_alone(changed);
    return alone(changed, "solve");
  };
  EXPECT_EQ(with(3, {"carry"}), "start dz rest");
  EXPECT_EQ(with(3, {"dz"}), "start rest");
  EXPECT_EQ(with(2, {"start", "state"}), "dz rest");
  EXPECT_EQ(with(2, {"start_of_all"}), "start dz rest");
}

}  // namespace
}  // namespace hamgen
