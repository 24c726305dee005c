// The stage of a member's step in a system whose sums stay loops: its elements, the gradient there,
// what the equations lack and their derivative.
#pragma once

#include <string>
#include <vector>

#include "generator/program/environment.hpp"
#include "generator/program/linear_terms.hpp"
#include "generator/program/local_velocity.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/program/program.hpp"
#include "generator/program/refinement_type.hpp"
#include "generator/program/routine_builder.hpp"
#include "generator/program/state_rounding.hpp"
#include "generator/program/step_weights.hpp"

namespace hamgen {

// carry + row, with what is small as a local of the body of this name, for it is added first.
Expression sum_of_row(RoutineBuilder& b, Body& body, const Expression& carry, const StageRow& row,
                      const std::string& small);
// bar = z + (carry + row); z alone where nothing moves it.
void set_stage(RoutineBuilder& b, Body& body, const Expression& bar, const Expression& z,
               const Expression& carry, const StageRow& row, const std::string& change);

// Do all derivatives of H vanish at zero?
[[nodiscard]] bool has_no_linear_terms(const Mechanics& mechanics);

// What the routines of such a step are made of.
class LoopStage {
 public:
  LoopStage(const Environment& environment, const LoweredStep& lowered)
      : environment_(environment),
        mechanics_(lowered.plan.equations.mechanics),
        plan_(lowered.plan),
        arrays_(*lowered.plan.arrays),
        n_(environment.degrees_of_freedom),
        tangent_(lowered.tangent),
        weights_(*uniform_parameters(plan_.equations.scheme.member())),
        is_quadratic_(arrays_.constant_matrix && has_no_linear_terms(mechanics_) &&
                      plan_.equations.has_exact_hessian()) {
    if (arrays_.reduced && !needs_drift() && !is_linear())
      velocity_ = local_velocity(mechanics_, "i");
    const bool moves_q = weights_.q_by_p.has_value() && !weights_.shares;
    if (is_sharp() && moves_q && !raised() && has_linear_forces(mechanics_)) weights_.split_flow();
    if (iterates(arrays_) && !is_linear())
      beside_ = loops_rounded_beside(plan_.equations, weights_, arrays_.reduced);
  }

 protected:
  [[nodiscard]] bool newton() const { return arrays_.method == ArrayMethod::newton; }
  [[nodiscard]] bool fixed_point() const { return arrays_.method == ArrayMethod::fixed_point; }
  // Note [linear equations in loops]
  // Constants are rounded alike at every step, and so are products with them: of the chain of 25 at
  // h = 1 the form drifts by 2e-3 units of rounding a step, and not at all where what the gradient,
  // the products and the rounded stage lose is known far below rounding.  It is what the equations
  // are solved for.
  [[nodiscard]] bool is_linear() const { return newton() && is_quadratic_; }
  [[nodiscard]] bool both() const { return arrays_.method == ArrayMethod::both; }
  [[nodiscard]] bool is_explicit() const {
    return arrays_.method == ArrayMethod::explicit_a || arrays_.method == ArrayMethod::explicit_b;
  }
  // Is there a rest beside dz?
  [[nodiscard]] bool has_rest() const { return iterates(arrays_) || is_explicit(); }
  // Does Newton's matrix change with the stage?
  [[nodiscard]] bool is_sharp() const { return (newton() && !is_linear()) || both(); }
  // Is there a ContractionRule?  Alone it has to know that the size of all increments together
  // falls from one iteration to the next: q does not wait for p.
  [[nodiscard]] bool settles() const {
    return both() || (fixed_point() && arrays_.reduced && plan_.rule == kFixedPointRule);
  }
  // Is it known what the torn momenta lose in rounding?
  [[nodiscard]] bool tells_momenta() const {
    return arrays_.reduced && settles() && !needs_drift();
  }
  [[nodiscard]] int unknowns() const { return arrays_.reduced ? n_ : 2 * n_; }
  [[nodiscard]] bool needs_drift() const { return arrays_.reduced && weights_.p_by_p.has_value(); }
  [[nodiscard]] bool raised() const { return plan_.equations.function.has_value(); }
  // Are there products with h besides the coefficients?
  [[nodiscard]] bool uses_h() const { return weights_.uses_h() || raised(); }
  [[nodiscard]] KernelRange elements() const { return counting("i", n_); }
  [[nodiscard]] std::vector<Argument> arguments(bool with_states) const;
  static std::vector<Place> given(const std::vector<Argument>& arguments);
  Expression coordinate(RoutineBuilder& b) const { return b.at("start", "value", {affine("i")}); }
  [[nodiscard]] Expression momentum(RoutineBuilder& b) const;
  [[nodiscard]] Expression lack(RoutineBuilder& b, bool momentum) const;
  // dH/dq_i and dH/dp_i.
  [[nodiscard]] Gradient slope(RoutineBuilder& b) const;
  static Expression state(RoutineBuilder& b, const char* object, const char* field);
  [[nodiscard]] Expression mass(RoutineBuilder& b) const;
  // 1 / (1 + h beta m): by what a torn momentum answers to what moves it.
  Expression own_share(RoutineBuilder& b) const;
  // start.slope = grad H at a stage.
  void add_gradient(Body& body, const Place& q, const Place& p) const;
  void add_gradient_at_stage(Body& body, bool in_parts) const;
  // start.lost = H'' zbar - start.slope, what rounding took from a linear gradient.
  [[nodiscard]] Routine gradient_error() const;
  // z + carry + row - bar with all that it loses, for an element of q or p.
  Expression exact_lack(RoutineBuilder& b, Body& body, bool is_p, const Expression& extra) const;
  // start.lack, far below rounding, and start.moved of the torn momenta, at a stage whose
  // start.slope is known.
  void add_exact_lack(RoutineBuilder& b, Body& body) const;
  // The call of a routine that takes the stage and these.
  [[nodiscard]] Call of_stage(const char* routine, std::vector<Place> arguments) const;
  // dz + rest = Z - z after the iteration, by start.slope and the way to the solution.
  void add_exact_result(RoutineBuilder& b) const;
  // The torn momenta:  pbar_i = (p_i - h (1 - alpha) V_i - h beta d_i) / (1 + h beta m_i).  With
  // them start.slope = grad H at the stage, and start.lack.
  [[nodiscard]] Routine evaluate(bool in_parts) const;
  // Does Newton's iteration have h in two parts, where it moves q?
  [[nodiscard]] bool in_parts() const { return weights_.splits_flow(); }
  // Note [two evaluations]
  // Newton's iteration has h in two parts where it needs them; the fixed point beside it does not,
  // and would take 6 % longer on FPUT chains.
  [[nodiscard]] const char* evaluation(bool in_parts) const {
    return in_parts && both() ? "evaluate_in_parts" : "evaluate";
  }
  // With the momenta torn out the derivative is I + D V'', else I - h (I/2 + C) J H''.
  [[nodiscard]] Routine differentiate() const;
  void add_rounded_state(RoutineBuilder& b) const;
  // zbar = z, as far as it is unknown.
  [[nodiscard]] Body from_state(RoutineBuilder& b) const;
  // Note [t is given]
  // Where it is known, tbar is set before an iteration and stays what it is, rounded: no equation
  // lacks anything of it.  Newton's matrix is without it, so that what it would move by, and move,
  // was hundreds of units of rounding of a light element; and the fixed point took what its
  // rounding moves, once, in a thousand elements, for a slow contraction.  Nothing depends on p_t.
  void add_time(RoutineBuilder& b, Body& body) const;
  void hold_time(RoutineBuilder& b, Body& body) const;
  // An element of what the state is rounded with, z or start.beside.
  [[nodiscard]] Expression rounded_with(RoutineBuilder& b, bool momentum) const;
  // zbar = z + h (I/2 + C) J grad H, with the gradient at hand.
  void add_stage(RoutineBuilder& b, Body& each) const;
  // dz, and rest where there is one, by the gradient at the stage: by Refinement's where the
  // unknowns were refined.
  void add_result(RoutineBuilder& b, bool refined) const;
  // What the equations lack at the stage, where the gradient is this.
  [[nodiscard]] Body lacks(RoutineBuilder& b, const Gradient& at, bool in_parts) const;

  const Environment& environment_;
  const Mechanics& mechanics_;
  const SolvePlan& plan_;
  const ArrayPlan& arrays_;
  int n_;
  bool tangent_;
  StepWeights weights_;
  std::optional<LocalVelocity> velocity_;  // of torn momenta
  bool has_coefficients_ = false;
  bool is_quadratic_;                    // is H, with a constant matrix?
  std::optional<StateRounding> beside_;  // what the unknowns are rounded with

 private:
  [[nodiscard]] Expression mass_of_result(RoutineBuilder& b) const;
  Expression lost_of_momentum(RoutineBuilder& b, Body& each) const;
  // What H'' times the last increment adds to dz.
  [[nodiscard]] Expression change_of_flow(RoutineBuilder& b, bool is_p) const;
};

}  // namespace hamgen
