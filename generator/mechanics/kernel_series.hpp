// The generating function of a system whose sums are kept, as sums like those of H.
//
// Of a sum over neighbours every term of the series is one: an instance of a kernel of H is moved
// by the slopes of those instances that reach its own elements, and at both ends there are fewer.
#pragma once

#include <vector>

#include "generator/algebra/sparse_matrix.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

// The kernels of K = S/h cut off after h^(order - 1), for the member of one degree of freedom with
// this C that all degrees of freedom share.  Throws UsageError where an instance meets more others
// than a fixed number of neighbours, and where K is too long.
[[nodiscard]] std::vector<Kernel> generating_kernels(const Mechanics& mechanics,
                                                     const SparseMatrix& c, int order);

}  // namespace hamgen
