// Functions of sums in H, as C^2 with C = sum(i = 1..N, cos(q[i])): the sums stay loops, and H has
// a function of a few numbers.
#pragma once

#include <optional>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/mechanics/split_sums.hpp"

namespace hamgen {

struct CollectiveSums {
  std::vector<CollectiveSum> sums;
  std::vector<std::vector<SumTerm>> terms;  // what each of them sums
  Expression value;                         // of the functions together
};

// Empty where they know of the state more than their sums, or one of them knows coordinates and
// momenta.
[[nodiscard]] std::optional<CollectiveSums> collective_sums(const Model& model,
                                                            const std::vector<Summand>& functions);

}  // namespace hamgen
