// Forces that vanish at z = 0 because their terms cancel there, as exp(q) - 1 does.
//
// Note [forces that cancel]
// Near such an equilibrium a force is rounded as its terms are, not as the state is: of a Toda ring
// whose particles are moved by 1e-8, by 1e8 units of it.  No iteration comes nearer to the solution
// than that, and one that waited for the rounding of the unknowns themselves would wait in vain, or
// take noise for a slow contraction.  So an unknown q is rounded with
//   D T / (1 + D V)
// besides, where q moves by D dH/dq in the equations of a step, T is the sum of the sizes of the
// terms of dH/dq at z = 0 and V that of d^2H/dq^2: what a rounding of the force is to the solution.
// It counts for nothing where |q| is not small beside T/V, the length over which the terms change;
// and where the state is further from zero than half of that, the terms may be other ones: what is
// small there is rounded as it is.  So the length is multiplied by
//   1/(1 + (sum of q_i^2 / (T/2V)^2)^8),
// 1 near zero and nothing far from it.  Where no term has a slope at zero, as in sin(q) - q, they
// do not round either, and there is no such length. Where arrays of unknowns or the end of an
// iteration have one such length for all, they have none unless all forces are alike: what stands
// beside them and is small would be rounded with it, too.
#pragma once

#include <functional>
#include <map>
#include <optional>

#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

// Of numbers and parameters.
struct CancellingForce {
  Expression terms;  // T
  Expression slope;  // V
  // 1/(T/2V)^2
  [[nodiscard]] Expression reach() const;
};
// The factor of a state whose sum of q_i^2 is so many times (T/2V)^2.
[[nodiscard]] Expression nearness(const Expression& far);

// dH/dz_k by k, where such terms depend on the state; not of systems whose sums are loops.
[[nodiscard]] std::map<int, CancellingForce> cancelling_forces(const Mechanics& mechanics);
// Of a system in loops dH/dq_i, where it is the same for all elements but those at the ends: of two
// arrays of which one has no such forces there is none.
[[nodiscard]] std::optional<CancellingForce> cancelling_force_in_loops(const Mechanics& mechanics);

// What an unknown that moves by `answer` times the force is rounded with besides.
[[nodiscard]] Expression rounded_beside(const CancellingForce& force, const Expression& answer);

// One for all of these unknowns: the first, if none is 0 or more than 16 times another where the
// parameters are as declared, the state is 0 and h = 2^-6.
[[nodiscard]] std::optional<Expression> common_length(const Mechanics& mechanics,
                                                      const std::vector<Expression>& lengths);

// Of every component of the state, near zero or not, 0 if there is nothing: zbar_i moves by
// weight(i, k) dH/dz_k.
using WeightOfGradient = std::function<Expression(int i, int k)>;
[[nodiscard]] std::vector<Expression> rounded_beside(const Mechanics& mechanics,
                                                     const WeightOfGradient& weight);

}  // namespace hamgen
