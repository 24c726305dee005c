// What a splitting, a composition or a Runge-Kutta method puts around the instructions of a
// LoweredStep: the numbers a format writes, and no others.
#pragma once

#include <vector>

#include "generator/schemes/scheme.hpp"

namespace hamgen {

// kick:    p -= length h dV/dq
// drift:   q += length h dT/dp
// member:  the program's own step with length h for h
enum class SubstepKind { kick, drift, member };
struct Substep {
  SubstepKind kind = SubstepKind::member;
  Expression length;
};

// With the program's vector field f, and the slopes k_j of all stages:
//   explicit   k_i = f(z + h sum_j coupling_ij k_j),  Z = z + h sum_i weight_i k_i
//   implicit   k_i = h weight_i f(z + sum_j coupling_ij k_j),  Z = z + sum_i k_i
struct StageTable {
  std::vector<std::vector<Expression>> coupling;
  std::vector<Expression> weight;
};

struct Sequence {
  std::vector<Substep> substeps;  // in the order of the step; empty for a single member
  StageTable stages;
};

[[nodiscard]] Sequence sequence_of(const Scheme& scheme);
[[nodiscard]] std::vector<Expression> lengths_of(const Sequence& sequence, SubstepKind kind);

}  // namespace hamgen
