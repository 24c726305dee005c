// Rules of several unknowns that have been taught.
#pragma once

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {

template <class Blocks>
class RulesOfMany : public ::testing::Test {
 protected:
  using Number = typename Blocks::Scalar;
  using Answer = typename Blocks::Answer;
  template <int Power, int Unknowns>
  using Rule = typename Blocks::template NewtonOfMany<Power, Unknowns>;

  // Increments of solutions of size 1 that are lost in rounding once squared, with 2^-20 to spare.
  static Number small() { return Blocks::two_to(-(Blocks::bits + 21) / 2); }

  // A rule of unknowns of size 1 that has seen increments s, s^2 * contraction in its first step.
  template <int Power, int Unknowns>
  static Rule<Power, Unknowns> taught(Number contraction) {
    Rule<Power, Unknowns> rule;
    for (Number& unit : rule.unit) unit = 1;
    rule.fresh = 0;
    const Number first = Blocks::two_to(-4);
    rule.begin(false);
    EXPECT_EQ(rule(first, Number(1), 1), Answer::go_on);
    rule(contraction * (Power == 2 ? first * first : first), Number(1), 2);
    // Straight: any increment may stand.
    rule.motion.move = Blocks::two_to(-4);
    rule.motion.least = rule.motion.move;
    rule.motion.bend = 0;
    for (Number& move : rule.moves) move = rule.motion.move;
    return rule;
  }
};

}  // namespace hamgen::numerics_blocks_test
