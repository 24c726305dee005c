// A large system in C++: State has Real q[n], p[n], and sums are loops.
#pragma once

#include "generator/formats/cpp_context.hpp"

namespace hamgen {

// energy(par, z); of a separable H potential_gradient(par, q, dq) and kinetic_gradient(par, p, dp),
// of any other, and where it is wanted, gradient(par, q, p, dq, dp); a matrix and
// hessian(par, q, [p,] put) where the plan solves with them.
void write_array_functions(CodeWriter& out, CppContext& context);
// Who takes the steps: the class Propagator, or in a composition the class Substep, which can go on
// from a state and a carry of another.
enum class StepRole { propagator, substep };
[[nodiscard]] std::string class_name(StepRole role);
// begin_at(z, carry), carry() and, if there is anything to `reset`, forget().
void write_substep_access(CodeWriter& out, const std::string& reset);

// The class that takes many steps of a member.
void write_array_propagator(CodeWriter& out, CppContext& context, StepRole role);

// h alpha, h (1 - alpha), h beta, h gamma: what the step is made of, each absent where it is zero.
struct ArrayWeights {
  std::string q_by_p, p_by_q, p_by_p, q_by_q;  // how they are called: "half_h_"
  // Members of the class and their values in its constructor, each once.
  std::vector<std::pair<std::string, Expression>> members;
  // h alpha and h (1 - alpha), to be made to sum to h: Note [weights that sum to h] in
  // program/step_builder.hpp.
  bool complementary = false;
};
[[nodiscard]] ArrayWeights array_weights(const FamilyParameters& member);
// The function step(), and the functions that an implicit one calls.
[[nodiscard]] std::string array_step(const Mechanics& mechanics, const SolvePlan& plan,
                                     const ArrayWeights& weights);
[[nodiscard]] std::string array_iteration(const Mechanics& mechanics, const ArrayPlan& plan,
                                          const ArrayWeights& weights);

// With --tangent, of a member: the member function tangent(m), what it multiplies by, and the free
// function.
[[nodiscard]] std::string array_tangent(const Mechanics& mechanics, const SolvePlan& plan,
                                        const ArrayWeights& weights, const ScalarType& scalar);
[[nodiscard]] std::string array_curvature(const ArrayPlan& plan);
void write_array_tangent_of(CodeWriter& out, StepRole role);
// Of a splitting: the free function.
void write_array_splitting_tangent(CodeWriter& out, const CppContext& context);
// Of a Runge-Kutta method: hessian(par, x, values) of the state as one array.
void write_array_stage_hessian(CodeWriter& out);

// slope_ = grad H at a state, as statements with this indentation.
[[nodiscard]] std::string gradient_at(const Mechanics& mechanics, const std::string& state,
                                      int indent);
// " + weight * value" for the weights that are there.
[[nodiscard]] std::string weighted(const char* sign, const std::string& weight,
                                   const std::string& value);
// qbar_i and pbar_i from the gradient at hand.
[[nodiscard]] std::string stage_q(const ArrayWeights& weights);
[[nodiscard]] std::string stage_p(const ArrayWeights& weights);

// The class Matrix: clear, put, factorise, solve.
void write_array_matrix(CodeWriter& out, const ArrayMatrix& matrix);

}  // namespace hamgen
