#include "generator/modified_terms.hpp"

#include <fmt/format.h>

#include "generator/base/diagnostic.hpp"
#include "generator/mechanics/modified_hamiltonian.hpp"

namespace hamgen {

std::vector<Expression> modified_terms(const Mechanics& mechanics, const Scheme& scheme,
                                       int count) {
  if (!scheme.is_member() || mechanics.keeps_sums()) {
    throw UsageError(
        fmt::format("the modified Hamiltonian is derived for members of the family and sums "
                    "that are written out, not for {} of {}",
                    scheme.name, mechanics.name));
  }
  const Member& member = scheme.member();
  if (!scheme.symplectic) {
    throw UsageError(fmt::format("{} is not symplectic: it follows no modified Hamiltonian",
                                 scheme.description));
  }
  // H_0, then from the order of the scheme on; of a symmetric one every other.
  const int stride = scheme.symmetric ? 2 : 1;
  const int last = count == 1 ? 0 : scheme.order + stride * (count - 2);
  return modified_hamiltonian(mechanics, member.c, member.generating_order, last + 1);
}

// Sweeps leave the step unsolved, and what is not symplectic has no modified Hamiltonian.
void require_solved_step(const Request& request) {
  if (request.solver->kind != SolverWish::Kind::sweeps) return;
  throw UsageError(
      fmt::format("--solver {} leaves the step unsolved: it follows no modified "
                  "Hamiltonian\nhelp: drop --solver",
                  request.solver.text()));
}

}  // namespace hamgen
