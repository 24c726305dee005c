// The modified Hamiltonian of a request's step.
#pragma once

#include <vector>

#include "generator/pipeline.hpp"

namespace hamgen {

// H_0, H_1, ... as `modified_hamiltonian` of pipeline.hpp hands them out.  Throws UsageError for a
// scheme that follows none, and for sums that stay loops.
[[nodiscard]] std::vector<Expression> modified_terms(const Mechanics& mechanics,
                                                     const Scheme& scheme, int count);
// Throws UsageError where sweeps leave the step unsolved.
void require_solved_step(const Request& request);

}  // namespace hamgen
