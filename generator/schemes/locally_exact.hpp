// The gauge that makes a member exact on the linear part of a system at one fixed point.
#pragma once

#include <string>
#include <vector>

#include "generator/algebra/evaluate.hpp"
#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

// C = (hA)^-1 - coth(hA/2)/2 with A = J H''(reference), a function of h.  It makes
// I/2 + C = (hA)^-1 - (exp(hA) - 1)^-1, for which the linear step Z = z + hA zbar is exp(hA) z.
// C is odd in h and lies in sp(2n), so that the member is symmetric, of order 2 and symplectic for
// every H; it has poles where h times a frequency of A is a multiple of 2 pi.
//
// `reference` has a value for every variable and every parameter.  Throws UsageError where H'' is
// not defined there, or A is too large or has no such function.
[[nodiscard]] Scheme locally_exact_member(const Mechanics& mechanics, const Values& reference);
// Throws the same where the first coordinate alone couples too many degrees of freedom; without
// the derivatives by all the others.
void require_sparse_row(const Expression& hamiltonian, const std::vector<std::string>& coordinates,
                        const std::vector<std::string>& momenta, const Values& reference);

}  // namespace hamgen
