// Do the powers of a symplectic matrix stay bounded?
#pragma once

#include "generator/verify/exact_matrix.hpp"

namespace hamgen {

// `bounded`: all eigenvalues have modulus 1 and as many eigenvectors as their multiplicity.
// `growing`: one has another modulus.  `resonant`: one lacks eigenvectors, and the powers grow like
// a power of their number.
enum class Powers { bounded, growing, resonant, undecided };

// In rationals: the characteristic polynomial in s = x + 1/x, its multiple roots, how many of its
// roots are between -2 and 2 (Sturm), and the ranks that tell multiple eigenvalues with
// eigenvectors from Jordan blocks.  Free motions are left out: each is a double eigenvalue 1 with
// one eigenvector. A matrix that is not `exact` is palindromic to its digits only.
[[nodiscard]] Powers powers_of(const ExactMatrix& m, int free_motions, bool exact);

// Of x^n q(x + 1/x), palindromic with coefficients c_0 = c_2n, ...: the factor of D_k(s) in q is
// c_(n+k), D_0 = 1, D_k(x + 1/x) = x^k + x^-k.  D_0, ..., D_n as polynomials.
[[nodiscard]] std::vector<RationalPolynomial> symmetric_powers(std::size_t n);

}  // namespace hamgen
