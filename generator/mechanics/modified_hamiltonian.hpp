// Backward error analysis: the Hamiltonian whose flow the step follows.
#pragma once

#include <vector>

#include "generator/algebra/sparse_matrix.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

// H_0, H_1, ..., H_(count - 1) of Ht = sum of h^j H_j: as a formal series, the step of size h of
// the member C with K of the given order (0 or 1: H itself) in place of H is the flow of Ht at time
// h. Throws UsageError if a term is too long to be written down.
[[nodiscard]] std::vector<Expression> modified_hamiltonian(const Mechanics& mechanics,
                                                           const SparseMatrix& c, int order,
                                                           int count);

}  // namespace hamgen
