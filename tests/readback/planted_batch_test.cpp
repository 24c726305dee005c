// Faults planted in the text of batches, where a number is one of each trajectory.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/readback/planted.hpp"

namespace hamgen::readback_test {
namespace {

TEST(PlantedFaultInABatch, OfTheTextIsFoundAtItsLine) {
  const Request eight{.batch = 8};
  const Request composed{.scheme = "yoshida-4", .batch = 8};
  const Request fixed_point{.solver = "fixed-point", .batch = 8};
  const std::vector<Fault> faults = {
      {"half as a quarter", "kepler", eight, "k.c1 = -0.5 * h", "k.c1 = -0.25 * h"},
      {"another function", "pendulum", eight, "lane_sin(", "lane_cos("},
      {"the library's function", "pendulum", eight, "lane_sin(", "library<std::sin>("},
      {"what is selected exchanged", "kepler", eight, "select(moving, q1_bar + delta_q1, q1_bar)",
       "select(moving, q1_bar, q1_bar + delta_q1)"},
      {"lanes that have stopped move on", "kepler", eight,
       "q1_bar = select(moving, q1_bar + delta_q1, q1_bar)", "q1_bar = q1_bar + delta_q1"},
      {"until all have stopped", "kepler", eight, "if (!any(moving)) break;",
       "if (any(moving)) break;"},
      {"a start value of all lanes", "kepler", eight,
       "start.value[0] = select(start.turn.lanes, q1_bar + delta_q1, start.value[0]);",
       "start.value[0] = q1_bar + delta_q1;"},
      {"a failed lane moves", "kepler", eight, "move_lanes(running_, z_.q1",
       "move_lanes(astray, z_.q1"},
      {"no lane fails", "kepler", eight, "stop_failed(running_, report);",
       "stop_failed(astray, report);"},
      {"the second try of all", "kepler", eight, "start_.turn.lanes = astray;",
       "start_.turn.lanes = running_;"},
      {"one lane's time", "kepler", eight, "return steps_ * h_;", "return h_;"},
      {"none runs at first", "kepler", eight, "Mask running_ = true;", "Mask running_ = false;"},
      {"a step that is not taken over", "kepler", eight, "z = propagator.state();",
       "if (report.converged) z = propagator.state();"},
      {"a block that is another", "kepler", eight, "struct Turn {", "struct Turn { int more;"},
      {"another number of lanes", "kepler", eight, "using Real = Pack<8>;",
       "using Real = Pack<4>;"},
      {"... in the class", "kepler", eight, "int lanes = 8;", "int lanes = 4;"},
      {"a substep's length", "kepler", composed, "lengths_[i] = h * fractions[i];",
       "lengths_[i] = h * fractions[0];"},
      {"a carry that is lost", "kepler", composed, "take_lanes(running_, carry_.q1, carry.q1)",
       "take_lanes(running_, carry_.q1, z.q1)"},
      {"a slope that is added", "fput", fixed_point, "carry.p[i] - p_push", "carry.p[i] + p_push"},
      {"a number is handed on as it is", "pendulum", eight,
       "inline Coefficients prepare(const Parameters&, const Real& h)",
       "inline Coefficients prepare(const Parameters&, Real& h)"},
  };
  for (const Fault& fault : faults) expect_found(fault);
}

TEST(ReadBackOfABatch, HasTheNumberOfTrajectoriesThatIsAskedFor) {
  Emitted file = emitted("kepler", {.batch = 8});
  EXPECT_EQ(file.read(file.text).outcome, ReadBack::Outcome::same);
  for (const int other : {0, 1, 4, 16}) {
    file.lanes = other;
    EXPECT_EQ(file.read(file.text).outcome, ReadBack::Outcome::different) << other;
  }
}

TEST(ReadBackOfABatch, EveryWordCounts) {
  expect_every_word_counts(emitted("pendulum", {.batch = 8}), 41);
  expect_every_word_counts(emitted("fput", {.batch = 4}), 97);
  expect_every_word_counts(emitted("kepler", {.scheme = "gauss-4", .batch = 2, .math = "libm"}),
                           97);
}

}  // namespace
}  // namespace hamgen::readback_test
