// The parts of the proof that the emitted code is the mathematics: claims about its routines, as
// they are printed and interpreted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/verify/derivatives.hpp"
#include "generator/verify/identities.hpp"
#include "generator/verify/proof.hpp"
#include "generator/verify/step_under_proof.hpp"

namespace hamgen {

// What a routine that is a function of the state computes.
class FunctionValues {
 public:
  FunctionValues(const StepUnderProof& step, const std::string& routine);
  [[nodiscard]] const std::optional<Expression>& result() const { return result_; }
  [[nodiscard]] Expression element(const std::string& array, long i);
  [[nodiscard]] std::vector<Statement> definitions() const { return machine_.definitions(); }

 private:
  SymbolicMachine machine_;
  std::optional<Expression> result_;
};

// The elements of an array of the routine, or what it returns, are these expressions.
[[nodiscard]] Identities values_identities(const StepUnderProof& step, const std::string& routine,
                                           const std::string& array, const std::string& what,
                                           const std::vector<Expression>& expected);

// solve of a member that is written out; `derivatives` are those of K at a higher order.
[[nodiscard]] Identities member_identities(const StepUnderProof& step,
                                           const Derivatives& derivatives, const Member& member,
                                           std::optional<int> sweeps);
// The same solve where derivatives have been evaluated before.
[[nodiscard]] Identities ready_identities(const StepUnderProof& step);
// All routines of a member whose sums are loops but the energy, what is made of H'', and its
// tangent map.
[[nodiscard]] std::vector<Identities> loop_member_identities(const StepUnderProof& step,
                                                             const Derivatives& derivatives,
                                                             const Member& member,
                                                             std::optional<int> sweeps);
// Of these, what is made of H'' in Newton's iteration, where there is one.
[[nodiscard]] std::vector<Identities> loop_hessian_identities(const StepUnderProof& step,
                                                              const Derivatives& derivatives,
                                                              const Member& member);

// solve of a splitting and of a Runge-Kutta method, with the gradients it calls as functions of
// which nothing is known; the substeps of a composition.
[[nodiscard]] std::vector<Identities> method_identities(const StepUnderProof& step,
                                                        const Derivatives& derivatives);
[[nodiscard]] std::vector<Identities> runge_kutta_identities(const StepUnderProof& step,
                                                             const Derivatives& derivatives,
                                                             const RungeKutta& tableau);

// The sum over all instances of the kernels, in the symbols of the state and of the parameters.
[[nodiscard]] Expression sum_of_kernels(const Mechanics& mechanics);
// Of sums that are loops: the derivatives of their summands, and that they sum up to H if that is
// given.
[[nodiscard]] std::vector<Identities> kernel_identities(
    const Mechanics& mechanics, const std::optional<Expression>& hamiltonian);

// The linearised step of a member that is written out.
[[nodiscard]] Identities tangent_identities(const StepUnderProof& step,
                                            const Derivatives& derivatives, const Member& member);

// grad K and the Hessian that Newton's iteration takes: a gradient, and one whose step follows the
// flow of H to its order, at random points.
[[nodiscard]] Decision decide_function(const Mechanics& mechanics, const Derivatives& derivatives,
                                       const Member& member, const GeneratingFunction& function,
                                       const Surroundings& around = {});
// K as it stands in the step's equations; kernels written out and differentiated anew.
[[nodiscard]] GeneratingFunction written_out_function(const StepEquations& equations);
// The same of a step that takes such a K, in whatever form; with many elements in loops of the
// `smaller` ones.
[[nodiscard]] Decision decide_raised(const Mechanics& mechanics, const SolvePlan& plan,
                                     const Program& program,
                                     const std::optional<Expression>& hamiltonian,
                                     const Surroundings& around,
                                     const std::optional<SmallerSystems>& smaller);

}  // namespace hamgen
