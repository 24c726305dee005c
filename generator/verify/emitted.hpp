// The parts of the proof that the emitted code is the mathematics.
#pragma once

#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/program.hpp"
#include "generator/verify/identities.hpp"

namespace hamgen {

// Results of a function of the state are these expressions.
[[nodiscard]] Identities identities_of(const Evaluation& evaluation, const std::string& what,
                                       const std::vector<Expression>& expected);

// A system whose sums stay loops: every loop's summand and its derivatives, and that the loops sum
// up to H.
[[nodiscard]] std::vector<Identities> kernel_identities(const Mechanics& mechanics,
                                                        const Expression& hamiltonian);

}  // namespace hamgen
