// What is proved of a step, property by property.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/program.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

// `tested`: no counterexample at many random points, which is less than a proof.  `measured`: a
// number, without a claim.
enum class Verdict { proved, tested, refuted, not_decided, measured };

struct Finding {
  std::string property;  // "symplectic"
  Verdict verdict = Verdict::not_decided;
  std::string detail;  // how, or the failing entry with its value, or why it is open
};

using Proof = std::vector<Finding>;

// Everything that can be decided by algebra about the scheme's step for this system, and about the
// program that computes it.  `hamiltonian` is H with its sums written out.
[[nodiscard]] Proof verify(const Mechanics& mechanics, const Scheme& scheme, const Program& program,
                           const Expression& hamiltonian);

// The single proofs.  A member must satisfy C J + J C^T = 0; the residual entries are exact.
[[nodiscard]] Finding prove_gauge(const Member& member);
// A+ J A+^T = A- J A-^T with a generic symmetric S of symbols, entry by entry, on the first
// min(n, 3) degrees of freedom; beyond, by the factorisation of the difference.
[[nodiscard]] Finding prove_step_symplectic(const Member& member);
[[nodiscard]] Finding prove_symmetric(const Member& member);
[[nodiscard]] Finding prove_order(const Member& member);
// A fixed number of sweeps in place of the solution: the order of M^T J M - J by its power series.
[[nodiscard]] Finding prove_swept(const Mechanics& mechanics, const Member& member, int sweeps);
// Splittings, compositions, tableaus: symplectic, symmetric, and their order found by formal
// series, which are looked at up to order + 1.  `nystrom`: T is quadratic in p.
[[nodiscard]] Proof prove_splitting(const Splitting& splitting, int order, bool nystrom);
[[nodiscard]] Finding prove_shears(const Splitting& splitting);
[[nodiscard]] Proof prove_composition(const Composition& composition, int order);
[[nodiscard]] Proof prove_tableau(const RungeKutta& tableau, int order);
// {I, H} = 0, and whether the scheme conserves I exactly.  `hamiltonian` is H written out.
[[nodiscard]] Proof prove_invariants(const Mechanics& mechanics, const Expression& hamiltonian,
                                     const Scheme& scheme, bool swept);
// The instructions of the program, substituted back into expressions, are the step's equations,
// their derivatives, their solution and H.
[[nodiscard]] Finding prove_emitted(const Mechanics& mechanics, const Scheme& scheme,
                                    const Program& program, const Expression& hamiltonian);

[[nodiscard]] std::string to_text(Verdict verdict);
[[nodiscard]] std::string to_text(const Proof& proof);

}  // namespace hamgen
