// What is proved of a step, property by property.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

enum class Verdict { proved, refuted, not_decided };

struct Finding {
  std::string property;  // "symplectic"
  Verdict verdict = Verdict::not_decided;
  std::string detail;    // how, or the failing entry with its value, or why it is open
};

using Proof = std::vector<Finding>;

// Everything that can be decided by algebra about the scheme's step for this system.  With sweeps, the
// step is not solved but swept that many times.
[[nodiscard]] Proof verify(const Mechanics& mechanics, const Scheme& scheme,
                           std::optional<int> sweeps);

// The single proofs.  A member must satisfy C J + J C^T = 0; the residual entries are exact.
[[nodiscard]] Finding prove_gauge(const Member& member);
// A+ J A+^T = A- J A-^T with a generic symmetric S of symbols, entry by entry, on the first
// min(n, 3) degrees of freedom; beyond, by the factorisation of the difference.
[[nodiscard]] Finding prove_step_symplectic(const Member& member);
[[nodiscard]] Finding prove_symmetric(const Member& member);
[[nodiscard]] Finding prove_order(const Member& member);
// {I, H} = 0, and whether the scheme conserves I exactly.
[[nodiscard]] Proof prove_invariants(const Mechanics& mechanics, const Member& member);

[[nodiscard]] std::string to_text(Verdict verdict);
[[nodiscard]] std::string to_text(const Proof& proof);

}  // namespace hamgen
