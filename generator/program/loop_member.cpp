#include "generator/program/loop_member.hpp"

#include <fmt/format.h>

#include "generator/program/arithmetic.hpp"
#include "generator/program/kernel_routines.hpp"
#include "generator/program/loop_coefficients.hpp"
#include "generator/program/loop_stage.hpp"
#include "generator/program/routine_builder.hpp"
#include "generator/program/step_weights.hpp"
#include "generator/program/tangent_products.hpp"

namespace hamgen {

namespace {

class LoopMember : LoopStage {
 public:
  LoopMember(Program& code, const Environment& environment, const LoweredStep& lowered)
      : LoopStage(environment, lowered), code_(code) {}

  void add() {
    const bool solved = iterates(arrays_);
    if (solved || plan_.sweeps) {
      if (std::optional<Coefficients> found = loop_coefficients(
              environment_, weights_, arrays_, tangent_, tells_momenta(), beside_)) {
        code_.records.push_back(std::move(found->record));
        code_.routines.push_back(std::move(found->prepare));
        has_coefficients_ = true;
      }
    }
    add_start_record();
    if (arrays_.reduced) code_.routines.push_back(evaluate(in_parts() && !both()));
    if (arrays_.reduced && in_parts() && both()) code_.routines.push_back(evaluate(true));
    if (arrays_.matrix) code_.routines.push_back(differentiate());
    if (is_sharp()) {
      code_.routines.push_back(curvature_routine(environment_, plan_.equations, curved_part()));
    }
    if (both()) {
      code_.routines.push_back(contract_routine());
      code_.routines.push_back(newton_routine());
    }
    if (is_linear()) {
      code_.routines.push_back(gradient_error());
      code_.routines.push_back(curvature_routine(environment_, plan_.equations));
    }
    code_.routines.push_back(solve());
    if (solved) code_.unknowns = unknowns();
    code_.retries = solved;
    if (is_sharp() && newton()) code_.rules = {{"rule", 0, unknowns()}};
    if (both()) code_.rules = {{"newton_rule", 0, unknowns()}};
    code_.matrix = arrays_.matrix;
  }

 private:
  // --- what is remembered ---------------------------------------------------------------------

  void add_start_record() {
    Record start{
        .name = "Start",
        .fields = {},
        .remark = {iterates(arrays_) ? "Start values of the implicit equations and what is "
                                       "remembered of their solution."
                                     : "Room for the stage."}};
    const auto array = [&](const char* name, int size, const char* remark) {
      start.fields.push_back({.name = name, .sizes = {size}, .remark = remark});
    };
    if (iterates(arrays_) || plan_.sweeps) {
      array("value", unknowns(), arrays_.reduced ? "the coordinates of zbar" : "zbar");
    } else {
      array("value", n_, arrays_.method == ArrayMethod::explicit_a ? "P" : "Q");
    }
    if (iterates(arrays_)) {
      start.fields.push_back({.name = "known",
                              .remark = "else the state itself is the start",
                              .values = {0},
                              .type = "bool"});
    }
    if (beside_) beside_->add_fields(start, unknowns());
    if (both() && !arrays_.reduced)
      array("expected", unknowns(), "what the fixed point began with");
    if (arrays_.reduced && !velocity_) array("momentum", n_, "of zbar");
    array("slope", 2 * n_, raised() ? "grad K(zbar), dK/dq first" : "grad H(zbar), dH/dq first");
    if (iterates(arrays_)) array("lack", unknowns(), "of the equations, then the increment");
    if (is_linear()) {
      array("lost", 2 * n_, "of the slope by rounding");
      array("moved", 2 * n_, "from the rounded stage to the solution");
      array("change", 2 * n_, "of the slope on that way");
    }
    if (is_sharp()) {
      array("change", arrays_.reduced ? n_ : 2 * n_, "of the slope by the last increment");
    }
    if (newton()) {
      const std::string rule = fmt::format("NewtonRuleOfMany<2, {}>", unknowns());
      start.fields.push_back({.name = "rule", .type = is_linear() ? "LinearRule" : rule});
    }
    if (newton() || both()) {
      start.fields.push_back({.name = "matrix", .type = "Matrix"});
      if (arrays_.constant_matrix) {
        start.fields.push_back({.name = "factorised", .values = {0}, .type = "bool"});
      }
    }
    if (both()) {
      start.fields.push_back(
          {.name = "newton_rule", .type = fmt::format("WaitingNewtonRule<2, {}>", unknowns())});
      start.fields.push_back(
          {.name = "patience", .remark = "steps left to Newton", .values = {0}, .type = "int"});
    }
    if (fixed_point() || both()) {
      // Where q waits for p, and p for q, two increments are compared.
      const auto* contraction = arrays_.reduced ? "ContractionRule<1>" : "ContractionRule<2>";
      start.fields.push_back(
          {.name = "rule", .type = settles() ? contraction : std::string(plan_.rule)});
      start.fields.push_back(
          {.name = "refinement", .type = refinement_type(unknowns(), 2 * n_, beside_.has_value())});
    }
    code_.records.push_back(std::move(start));
  }

  // --- the step --------------------------------------------------------------------------------

  Routine solve() {
    RoutineBuilder b(
        {.name = "solve",
         .remark = {has_rest() ? "dz + rest = Z - z for one step from z + carry; rest is small."
                               : "dz = Z - z for one step from z + carry."},
         .result = {.type = "StepReport", .object = "report"}});
    std::vector<Argument>& list = b.routine().arguments;
    list = arguments(true);
    if (!uses_h()) list.insert(list.end() - 3, {.name = "h"});
    list.push_back(state_argument("dz", true));
    if (has_rest()) list.push_back(state_argument("rest", true));
    switch (arrays_.method) {
      case ArrayMethod::explicit_a:
      case ArrayMethod::explicit_b:
        add_explicit(b, arrays_.method == ArrayMethod::explicit_a);
        break;
      case ArrayMethod::sweeps:
        add_sweeps(b);
        break;
      case ArrayMethod::newton:
        add_start(b);
        is_linear() ? add_linear(b) : add_newton(b);
        break;
      case ArrayMethod::fixed_point:
        add_start(b);
        add_fixed_point(b);
        break;
      case ArrayMethod::both:
        add_start(b);
        add_alternate(b);
        return b.take();
      case ArrayMethod::gradient_only:
        break;
    }
    if (is_linear()) {
      add_exact_result(b);
    } else {
      add_result(b, fixed_point());
    }
    return b.take();
  }

  // alpha = 0 has zbar = (q, P), alpha = 1 has zbar = (Q, p).
  void add_explicit(RoutineBuilder& b, bool kick_first) const {
    const char* from = kick_first ? "q" : "p";
    const char* to = kick_first ? "p" : "q";
    const Place force{"start", "slope"};
    const Place velocity{"start", "slope", {affine(n_)}};
    const char* first = kick_first ? "potential_gradient" : "kinetic_gradient";
    const char* second = kick_first ? "kinetic_gradient" : "potential_gradient";
    b.body().push_back({Call{.routine = first,
                             .arguments = {{"par"}, {"z", from}, kick_first ? force : velocity}}});
    const Expression z = state(b, "z", to);
    const Expression carry = state(b, "carry", to);
    const Gradient at = slope(b);
    Body each;
    const std::string stem = kick_first ? "p_" : "q_";  // see Note [rounded once]
    const Expression gradient = kick_first ? at.by_q : -at.by_p;
    const Expression flow = b.let(each, stem + "flow", step_size() * gradient);
    const auto names = [&](TermRole role, const Expression& value) {
      return b.let(each, stem + (role == TermRole::difference ? "sum" : "lost"), value);
    };
    const RoundedTerm sum = rounded_difference(names, z, {flow}, Errors::of_all);
    const Expression small = b.let(each, stem + "small", sum.small + carry);
    each.push_back({Assign{coordinate(b).name(), sum.large + small}});
    b.body().push_back(for_each(elements(), std::move(each)));
    b.body().push_back(
        {Call{.routine = second,
              .arguments = {{"par"}, {"start", "value"}, kick_first ? velocity : force}}});
  }

  // The paper's Algorithm 1: Z by explicit Euler, then zbar and Z again and again.
  void add_sweeps(RoutineBuilder& b) const {
    add_gradient(b.body(), {"z", "q"}, {"z", "p"});
    Body sweep;
    Body each;
    add_stage(b, each);
    sweep.push_back(for_each(elements(), std::move(each)));
    add_gradient_at_stage(sweep, false);
    b.body().push_back({Sweep{.count = *plan_.sweeps, .unknowns = {}, .body = std::move(sweep)}});
  }

  void add_start(RoutineBuilder& b) const {
    b.body().push_back({If{{"start", "known"}, false, from_state(b)}});
    add_time(b, b.body());
    add_rounded_state(b);
  }
  [[nodiscard]] Body iteration_body(RoutineBuilder& b, bool in_parts) const {
    Body body;
    add_gradient_at_stage(body, in_parts);
    if (!arrays_.reduced) body.push_back(for_each(elements(), lacks(b, slope(b), in_parts)));
    hold_time(b, body);
    return body;
  }

  void add_linear(RoutineBuilder& b) const {
    Body body;
    add_gradient_at_stage(body, false);
    add_matrix(body);
    add_exact_lack(b, body);
    body.push_back({SolveFactorised{{"start", "matrix"}, {"start", "lack"}}});
    b.body().push_back({IterateArray{.rule = Rule::linear,
                                     .name = "rule",
                                     .ranges = {elements()},
                                     .unknowns = unknown_arrays(b),
                                     .body = std::move(body)},
                        {"Linear equations are solved for what they lack."}});
  }

  // Note [the gradient of the last iteration]
  // It serves, with H'' times the last increment.  Taken once more, at the rounded solution, its
  // rounding errors are not independent of what is rounded: by them the form of a soft chain of 25
  // at h = 1 drifts by 2e-3 units of rounding a step.
  void add_newton(RoutineBuilder& b) const {
    Body body = iteration_body(b, in_parts());
    add_matrix(body);
    body.push_back({SolveFactorised{{"start", "matrix"}, {"start", "lack"}}});
    IterateArray iterate{.rule = Rule::newton,
                         .name = both() ? "newton_rule" : "rule",
                         .ranges = {elements()},
                         .unknowns = unknown_arrays(b),
                         .body = std::move(body),
                         .values = {"start", beside_ ? "beside" : "value"},
                         .increments = {"start", "lack"},
                         .count = static_cast<int>(unknowns())};
    b.body().push_back({std::move(iterate), {"Newton's iteration on what the equations lack."}});
    add_change_of_slope(b.body());
    const Expression value = b.at("start", "value", {affine("i")});
    Body last{{Accumulate{value.name(), b.at("start", "lack", {affine("i")})}}};
    b.body().push_back(for_each(counting("i", unknowns()), std::move(last)));
  }
  void add_change_of_slope(Body& body) const {
    std::vector<Place> list = {{"par"}};
    if (raised()) list.push_back({"h"});
    list.push_back({"start", "value"});
    if (!arrays_.reduced) list.push_back({"start", "value", {affine(n_)}});
    list.push_back({"start", "lack"});
    list.push_back({"start", "change"});
    body.push_back({Call{.routine = curvature_name(curved_part()), .arguments = std::move(list)}});
  }
  // With the momenta torn out T'' is constant, and moves by what V'' does.
  [[nodiscard]] Part curved_part() const { return arrays_.reduced ? Part::potential : Part::all; }

  void add_fixed_point(RoutineBuilder& b) const {
    Body body = iteration_body(b, false);
    const Body refined = body;
    IterateArray iterate{.rule = Rule::fixed_point,
                         .name = "rule",
                         .ranges = {elements()},
                         .unknowns = unknown_arrays(b),
                         .body = std::move(body),
                         .leaves_last = true};
    if (settles()) iterate.work = both() ? arrays_.matrix_work : 0;
    if (settles() && arrays_.reduced) iterate.refinement = "refinement";
    b.body().push_back({std::move(iterate), {"Fixed-point iteration."}});
    b.body().push_back({RefineArray{.refinement = {"start", "refinement"},
                                    .point = {"start", "value"},
                                    .lack = {"start", "lack"},
                                    .gradient = {"start", "slope"},
                                    .rule = settles() ? "rule" : "",
                                    .count = unknowns(),
                                    .components = 2 * n_,
                                    .begun = true,
                                    .gives_up = both(),
                                    .beside = beside_ ? refined_length(b) : Expression(0),
                                    .body = refined},
                        {kRefinementRemark}});
  }

  // --- the fixed point, and Newton behind it ---------------------------------------------------

  [[nodiscard]] std::vector<Argument> arguments_of_either() const {
    std::vector<Argument> list = arguments(true);
    if (!uses_h()) list.insert(list.end() - 3, {.name = "h"});
    list.push_back(state_argument("dz", true));
    list.push_back(state_argument("rest", true));
    list.push_back({.name = "report", .record = "StepReport", .changes = true});
    return list;
  }
  [[nodiscard]] Routine contract_routine() const {
    RoutineBuilder b({.name = "contract",
                      .remark = {"False if the fixed point contracts so slowly that Newton's "
                                 "matrix is worth its work."},
                      .result = {.type = "bool"},
                      .arguments = arguments_of_either()});
    add_fixed_point(b);
    add_result(b, true);
    return b.take();
  }
  [[nodiscard]] Routine newton_routine() const {
    RoutineBuilder b(
        {.name = "newton", .result = {.type = "bool"}, .arguments = arguments_of_either()});
    add_newton(b);
    add_result(b, false);
    return b.take();
  }
  void add_alternate(RoutineBuilder& b) const {
    const auto call = [&](const char* routine) {
      return Call{.routine = routine, .arguments = given(arguments_of_either())};
    };
    Body before;
    Body between;
    if (arrays_.reduced) {
      between = from_state(b);
      add_time(b, between);
      between.push_back({SetFlag{{"start", "known"}, false}});
    } else {
      const Expression value = b.at("start", "value", {affine("i")});
      const Expression expected = b.at("start", "expected", {affine("i")});
      const auto copied = [&](const Expression& to, const Expression& from) {
        return for_each(counting("i", unknowns()), {{Assign{to.name(), from}}});
      };
      before.push_back(copied(expected, value));
      between.push_back(copied(value, expected));
    }
    b.body().push_back(
        {Alternate{.first = call("contract"),
                   .second = call("newton"),
                   .patience = {"start", "patience"},
                   .steps = kStepsOfNewton,
                   .between = std::move(between),
                   .before = std::move(before)},
         {fmt::format("Newton where the fixed point contracts slowly{}, and then "
                      "for {} steps.",
                      arrays_.reduced ? ", from the state too" : "", kStepsOfNewton)}});
    b.body().push_back({Return{}});
  }

  void add_matrix(Body& body) const {
    const Place matrix{"start", "matrix"};
    std::vector<Place> list = {{"par"}};
    if (has_coefficients_) list.push_back({"k"});
    if (uses_h()) list.push_back({"h"});
    list.push_back({"start", "value"});
    list.push_back(matrix);
    Body fresh;
    fresh.push_back({Call{.routine = "differentiate", .arguments = std::move(list)}});
    fresh.push_back({Factorise{matrix}});
    if (arrays_.constant_matrix) {
      const Place flag{"start", "factorised"};
      fresh.push_back({SetFlag{flag, true}});
      body.push_back({If{flag, false, std::move(fresh)}});
    } else {
      for (Instruction& instruction : fresh) body.push_back(std::move(instruction));
    }
  }

  [[nodiscard]] std::vector<UnknownArray> unknown_arrays(RoutineBuilder& b) const {
    std::vector<UnknownArray> list;
    for (const long first : {0, n_}) {
      if (first == unknowns()) break;
      const std::vector<AffineIndex> index = {affine("i", first)};
      list.push_back({.value = b.at("start", "value", index).name(),
                      .increment = b.at("start", "lack", index).name(),
                      .beside = rounded_with(b, first != 0),
                      .by_torn = arrays_.reduced,
                      .index = index.front()});
    }
    return list;
  }

  Program& code_;
};

}  // namespace

void add_loop_member(Program& code, const Environment& environment, const LoweredStep& lowered) {
  LoopMember(code, environment, lowered).add();
}

}  // namespace hamgen
