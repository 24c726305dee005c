// The parts of the proof that the emitted code is the mathematics.
#pragma once

#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/program.hpp"
#include "generator/verify/expected_step.hpp"
#include "generator/verify/identities.hpp"

namespace hamgen {

// Results of a function of the state are these expressions.
[[nodiscard]] Identities identities_of(const Evaluation& evaluation, const std::string& what,
                                       const std::vector<Expression>& expected);

// A system whose sums stay loops: every loop's summand and its derivatives, and that the loops sum
// up to H.
[[nodiscard]] std::vector<Identities> kernel_identities(const Mechanics& mechanics,
                                                        const Expression& hamiltonian);

// The substeps of a splitting or composition and the coefficients of a Runge-Kutta method, as they
// are written.
[[nodiscard]] Identities sequence_identities(const Scheme& scheme, const Sequence& sequence);

// The linearised step of a member, if it is written too.
[[nodiscard]] Identities tangent_identities(const Mechanics& mechanics,
                                            const Derivatives& derivatives, const Member& member,
                                            const Linearisation& linearisation);

// grad K and the Hessian that Newton's iteration takes: a gradient, and one whose step follows the
// flow of H to its order, at random points.
[[nodiscard]] Decision decide_function(const Mechanics& mechanics, const Derivatives& derivatives,
                                       const Member& member, const GeneratingFunction& function,
                                       const Surroundings& around = {});

}  // namespace hamgen
