#include "generator/program/loop_member.hpp"

#include <fmt/format.h>

#include "generator/program/kernel_routines.hpp"
#include "generator/program/loop_coefficients.hpp"
#include "generator/program/routine_builder.hpp"
#include "generator/program/step_weights.hpp"

namespace hamgen {

namespace {

// z + (carry + row), what is small first; z alone where nothing moves it.
void set_stage(RoutineBuilder& b, Body& body, const Expression& bar, const Expression& z,
               const Expression& carry, const StageRow& row, const std::string& change) {
  if (row.large.empty()) return body.push_back({Assign{bar.name(), z}});
  Expression sum = carry + row.small;
  for (const Expression& term : row.large) sum += term;
  body.push_back({Assign{bar.name(), z + b.let(body, change, sum)}});
}

// What z + carry + row lacks of bar: z, bar and what is large cancel without an error, and come
// first.
Expression lacking(const Expression& z, const Expression& bar, const Expression& carry,
                   const StageRow& row) {
  Expression sum = z - bar;
  for (const Expression& term : row.large) sum += term;
  return row.large.empty() ? sum : sum + (carry + row.small);
}

constexpr int kStepsOfNewton = 32;

class LoopMember {
 public:
  LoopMember(Program& code, const Environment& environment, const LoweredStep& lowered)
      : code_(code),
        environment_(environment),
        mechanics_(lowered.plan.equations.mechanics),
        plan_(lowered.plan),
        arrays_(*lowered.plan.arrays),
        n_(environment.degrees_of_freedom),
        tangent_(lowered.tangent),
        weights_(*uniform_parameters(plan_.equations.scheme.member())) {}

  void add() {
    const bool solved = iterates(arrays_);
    if (solved || plan_.sweeps) {
      if (std::optional<Coefficients> found =
              loop_coefficients(environment_, weights_, arrays_, tangent_)) {
        code_.records.push_back(std::move(found->record));
        code_.routines.push_back(std::move(found->prepare));
        has_coefficients_ = true;
      }
    }
    add_start_record();
    if (arrays_.reduced) code_.routines.push_back(evaluate());
    if (arrays_.matrix) code_.routines.push_back(differentiate());
    if (both()) {
      code_.routines.push_back(contract_routine());
      code_.routines.push_back(newton_routine());
    }
    code_.routines.push_back(solve());
    if (solved) code_.unknowns = unknowns();
    code_.retries = solved;
    if (newton()) code_.rules = {{"rule", 0, unknowns()}};
    if (both()) code_.rules = {{"newton_rule", 0, unknowns()}};
    code_.matrix = arrays_.matrix;
  }

 private:
  [[nodiscard]] bool newton() const { return arrays_.method == ArrayMethod::newton; }
  [[nodiscard]] bool fixed_point() const { return arrays_.method == ArrayMethod::fixed_point; }
  [[nodiscard]] bool both() const { return arrays_.method == ArrayMethod::both; }
  // The size of all increments together then falls from one iteration to the next: q does not wait
  // for p.
  [[nodiscard]] bool settles() const { return both() || (fixed_point() && arrays_.reduced); }
  [[nodiscard]] int unknowns() const { return arrays_.reduced ? n_ : 2 * n_; }
  [[nodiscard]] bool needs_drift() const { return arrays_.reduced && weights_.p_by_p.has_value(); }
  [[nodiscard]] KernelRange elements() const { return counting("i", n_); }

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
    if (arrays_.reduced) array("momentum", n_, "of zbar");
    array("slope", 2 * n_, "grad H(zbar), dH/dq first");
    if (iterates(arrays_))
      array("lack", unknowns(), "of the equations at zbar, then the increment");
    if (newton()) start.fields.push_back({.name = "rule", .type = "NewtonRule<2>"});
    if (newton() || both()) {
      start.fields.push_back({.name = "matrix", .type = "Matrix"});
      if (arrays_.constant_matrix) {
        start.fields.push_back({.name = "factorised", .values = {0}, .type = "bool"});
      }
    }
    if (both()) {
      start.fields.push_back({.name = "newton_rule", .type = "WaitingNewtonRule<2>"});
      start.fields.push_back(
          {.name = "patience", .remark = "steps left to Newton", .values = {0}, .type = "int"});
    }
    if (fixed_point() || both()) {
      start.fields.push_back(
          {.name = "rule", .type = settles() ? "ContractionRule" : "FixedPointRule<2>"});
      start.fields.push_back(
          {.name = "refinement", .type = fmt::format("Refinement<{}, {}>", unknowns(), 2 * n_)});
    }
    code_.records.push_back(std::move(start));
  }

  [[nodiscard]] std::vector<Argument> arguments(bool with_states) const {
    std::vector<Argument> list = {parameters_argument()};
    if (has_coefficients_) list.push_back({.name = "k", .record = "Coefficients"});
    if (weights_.uses_h()) list.push_back({.name = "h"});
    if (with_states) {
      list.push_back(state_argument("z"));
      list.push_back(state_argument("carry"));
    }
    list.push_back({.name = "start", .record = "Start", .changes = true});
    return list;
  }
  static std::vector<Place> given(const std::vector<Argument>& arguments) {
    std::vector<Place> list;
    for (const Argument& argument : arguments) list.push_back({argument.name});
    return list;
  }

  // --- elements ------------------------------------------------------------------------------

  Expression coordinate(RoutineBuilder& b) const { return b.at("start", "value", {affine("i")}); }
  Expression momentum(RoutineBuilder& b) const {
    return arrays_.reduced ? b.at("start", "momentum", {affine("i")})
                           : b.at("start", "value", {affine("i", n_)});
  }
  Expression lack(RoutineBuilder& b, bool momentum) const {
    return b.at("start", "lack", {affine("i", momentum ? n_ : 0)});
  }
  // dH/dq_i and dH/dp_i.
  Gradient slope(RoutineBuilder& b) const {
    return {b.at("start", "slope", {affine("i")}), b.at("start", "slope", {affine("i", n_)})};
  }
  static Expression state(RoutineBuilder& b, const char* object, const char* field) {
    return b.at(object, field, {affine("i")});
  }

  Expression mass(RoutineBuilder& b) const {
    return b.at("k", "mass", loop_mass_index(arrays_, "i"));
  }

  // start.slope = grad H at a stage.
  void add_gradient(Body& body, const Place& q, const Place& p) const {
    const Place dq{"start", "slope"};
    const Place dp{"start", "slope", {affine(n_)}};
    if (!mechanics_.is_separable()) {
      body.push_back({Call{.routine = "gradient", .arguments = {{"par"}, q, p, dq, dp}}});
      return;
    }
    body.push_back({Call{.routine = "potential_gradient", .arguments = {{"par"}, q, dq}}});
    body.push_back({Call{.routine = "kinetic_gradient", .arguments = {{"par"}, p, dp}}});
  }
  void add_gradient_at_stage(Body& body) const {
    if (arrays_.reduced) {
      const std::vector<Place> list = given(arguments(true));
      body.push_back({Call{.routine = "evaluate", .arguments = list}});
    } else {
      add_gradient(body, {"start", "value"}, {"start", "value", {affine(n_)}});
    }
  }

  // The torn momenta:  pbar_i = (p_i - h (1 - alpha) V_i - h beta d_i) / (1 + h beta m_i).
  Routine evaluate() const {
    RoutineBuilder b({.name = "evaluate",
                      .remark = {"grad H at the stage, whose momenta follow from its coordinates."},
                      .arguments = arguments(true)});
    const Place p{"start", "momentum"};
    const Place dp{"start", "slope", {affine(n_)}};
    const Instruction force{Call{.routine = "potential_gradient",
                                 .arguments = {{"par"}, {"start", "value"}, {"start", "slope"}}}};
    const Instruction velocity{Call{.routine = "kinetic_gradient", .arguments = {{"par"}, p, dp}}};
    b.body().push_back(force);
    const Expression z = state(b, "z", "p");
    const Expression bar = momentum(b);
    const Expression carry = state(b, "carry", "p");
    const Gradient at = slope(b);
    Body each;
    if (!needs_drift()) {
      const StageRow row = weights_.row_of_p(b, each, at);
      set_stage(b, each, bar, z, carry, row, "change");
      b.body().push_back(for_each(elements(), std::move(each)));
      b.body().push_back(velocity);
      return b.take();
    }
    const Expression own =
        Expression::power(Expression(1) + *weights_.p_by_p * mass(b), Expression(-1));
    const Expression drift = b.at("k", "drift", {affine("i")});
    const StageRow first = weights_.row_of_p(b, each, {at.by_q, drift});
    set_stage(b, each, bar, z, carry, first, "change");
    each.push_back({Assign{bar.name(), bar * own}});
    b.body().push_back(for_each(elements(), std::move(each)));
    b.body().push_back(velocity);
    Body again;
    const StageRow row = weights_.row_of_p(b, again, at);
    const Expression missing = b.let(again, "missing", lacking(z, bar, carry, row));
    again.push_back({Assign{bar.name(), bar + missing * own}});
    b.body().push_back(for_each(elements(), std::move(again)));
    b.body().back().remark = {"What their rows lack there, rounded as they are."};
    b.body().push_back(velocity);
    return b.take();
  }

  // With the momenta torn out the derivative is I + D V'', else I - h (I/2 + C) J H''.
  Routine differentiate() const {
    std::vector<Argument> list = {parameters_argument()};
    if (has_coefficients_) list.push_back({.name = "k", .record = "Coefficients"});
    if (weights_.uses_h()) list.push_back({.name = "h"});
    list.push_back({.name = "at", .sizes = {unknowns()}, .decays = true});
    list.push_back({.name = "matrix", .record = "Matrix", .changes = true});
    RoutineBuilder b({.name = "differentiate",
                      .remark = {"The derivative of the equations' residual, q first, at a stage."},
                      .arguments = std::move(list)});
    b.body().push_back({Clear{{"matrix"}}});
    Body one{{Put{{"matrix"}, affine("i"), affine("i"), Expression(1)}}};
    b.body().push_back(for_each(counting("i", unknowns()), std::move(one)));
    const Part part = arrays_.reduced ? Part::potential : Part::all;
    const StepWeights weights = weights_;
    const bool reduced = arrays_.reduced;
    const bool one_scale = arrays_.mass.has_value();
    const int n = n_;
    const auto use = [=](Routine& routine, Body& body, const HessianEntry& entry) {
      const auto coefficient = [&](const Place& place) {
        routine.places.insert_or_assign(to_text(place), place);
        return Expression::symbol(to_text(place), kRankOfVariable);
      };
      const auto put = [&](AffineIndex row, long offset, const Expression& weight) {
        row.constant += offset;
        AffineIndex column = entry.column.index;
        if (entry.column.is_momentum) column.constant += n;
        body.push_back({Put{{"matrix"}, row, column, weight * entry.value}});
      };
      const AffineIndex& row = entry.row.index;
      if (reduced) {
        put(row, 0,
            coefficient({"k", "scale",
                         one_scale ? std::vector<AffineIndex>{} : std::vector<AffineIndex>{row}}));
        return;
      }
      // dH/dp moves q by alpha and p by beta, dH/dq moves p by 1 - alpha and q by gamma.
      weights.bind(routine);
      const auto& to_q = entry.row.is_momentum ? weights.q_by_p : weights.q_by_q;
      const auto& to_p = entry.row.is_momentum ? weights.p_by_p : weights.p_by_q;
      if (to_q) put(row, 0, -*to_q);
      if (to_p) put(row, n, *to_p);
    };
    return kernel_entries(environment_, mechanics_, part, b.take(), {"at"},
                          {"at", {}, {affine(n_)}}, use);
  }

  // --- the step --------------------------------------------------------------------------------

  Routine solve() {
    RoutineBuilder b(
        {.name = "solve",
         .remark = {fixed_point() || both()
                        ? "dz + rest = Z - z for one step from z + carry; rest is small."
                        : "dz = Z - z for one step from z + carry."},
         .result = {.type = "StepReport", .object = "report"}});
    std::vector<Argument>& list = b.routine().arguments;
    list = arguments(true);
    if (!weights_.uses_h()) list.insert(list.end() - 3, {.name = "h"});
    list.push_back(state_argument("dz", true));
    if (fixed_point() || both()) list.push_back(state_argument("rest", true));
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
        add_newton(b);
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
    add_result(b, fixed_point());
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
    const StageRow row{.large = {step_size() * (kick_first ? -at.by_q : at.by_p)}};
    set_stage(b, each, coordinate(b), z, carry, row, "change");
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
    add_gradient_at_stage(sweep);
    b.body().push_back({Sweep{.count = *plan_.sweeps, .unknowns = {}, .body = std::move(sweep)}});
  }

  // zbar = z + h (I/2 + C) J grad H, with the gradient at hand.
  void add_stage(RoutineBuilder& b, Body& each) const {
    const Gradient at = slope(b);
    for (const bool is_p : {false, true}) {
      const char* field = is_p ? "p" : "q";
      const Expression z = state(b, "z", field);
      const Expression carry = state(b, "carry", field);
      const StageRow row = is_p ? weights_.row_of_p(b, each, at) : weights_.row_of_q(b, each, at);
      set_stage(b, each, is_p ? momentum(b) : coordinate(b), z, carry, row,
                is_p ? "p_change" : "q_change");
    }
  }

  // zbar = z, as far as it is unknown.
  [[nodiscard]] Body from_state(RoutineBuilder& b) const {
    Body copy;
    const Expression q = state(b, "z", "q");
    copy.push_back({Assign{coordinate(b).name(), q}});
    if (!arrays_.reduced) {
      const Expression p = state(b, "z", "p");
      copy.push_back({Assign{momentum(b).name(), p}});
    }
    Body all;
    all.push_back(for_each(elements(), std::move(copy)));
    return all;
  }
  void add_start(RoutineBuilder& b) const {
    b.body().push_back({If{{"start", "known"}, false, from_state(b)}});
  }
  [[nodiscard]] Body iteration_body(RoutineBuilder& b) const {
    Body body;
    add_gradient_at_stage(body);
    body.push_back(for_each(elements(), lacks(b)));
    return body;
  }

  void add_newton(RoutineBuilder& b) const {
    Body body = iteration_body(b);
    add_linear_solve(body);
    b.body().push_back({IterateArray{.rule = Rule::newton,
                                     .name = both() ? "newton_rule" : "rule",
                                     .ranges = {elements()},
                                     .unknowns = unknown_arrays(b),
                                     .body = std::move(body)},
                        {"Newton's iteration on what the equations lack."}});
    const Expression value = b.at("start", "value", {affine("i")});
    Body last{{Accumulate{value.name(), b.at("start", "lack", {affine("i")})}}};
    b.body().push_back(for_each(counting("i", unknowns()), std::move(last)));
    add_gradient_at_stage(b.body());
  }

  void add_fixed_point(RoutineBuilder& b) const {
    Body body = iteration_body(b);
    const Body refined = body;
    IterateArray iterate{.rule = Rule::fixed_point,
                         .name = "rule",
                         .ranges = {elements()},
                         .unknowns = unknown_arrays(b),
                         .body = std::move(body)};
    if (settles()) iterate.work = both() ? arrays_.matrix_work : 0;
    b.body().push_back({std::move(iterate), {"Fixed-point iteration."}});
    b.body().push_back({RefineArray{.refinement = {"start", "refinement"},
                                    .point = {"start", "value"},
                                    .lack = {"start", "lack"},
                                    .gradient = {"start", "slope"},
                                    .rule = settles() ? "rule" : "",
                                    .count = unknowns(),
                                    .components = 2 * n_,
                                    .body = refined},
                        {kRefinementRemark}});
  }

  // --- the fixed point, and Newton behind it ---------------------------------------------------

  [[nodiscard]] std::vector<Argument> arguments_of_either() const {
    std::vector<Argument> list = arguments(true);
    if (!weights_.uses_h()) list.insert(list.end() - 3, {.name = "h"});
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
    Body between = from_state(b);
    between.push_back({SetFlag{{"start", "known"}, false}});
    b.body().push_back({Alternate{.first = call("contract"),
                                  .second = call("newton"),
                                  .patience = {"start", "patience"},
                                  .steps = kStepsOfNewton,
                                  .between = std::move(between)},
                        {fmt::format("Newton where the fixed point contracts slowly, and then for "
                                     "{} steps.",
                                     kStepsOfNewton)}});
    b.body().push_back({Return{}});
  }

  // What the equations lack at the stage.
  Body lacks(RoutineBuilder& b) const {
    Body each;
    const Gradient at = slope(b);
    for (const bool is_p : {false, true}) {
      if (is_p && arrays_.reduced) break;
      const char* field = is_p ? "p" : "q";
      const Expression z = state(b, "z", field);
      const Expression bar = is_p ? momentum(b) : coordinate(b);
      const StageRow row = is_p ? weights_.row_of_p(b, each, at) : weights_.row_of_q(b, each, at);
      each.push_back(
          {Assign{lack(b, is_p).name(), lacking(z, bar, state(b, "carry", field), row)}});
    }
    return each;
  }

  void add_linear_solve(Body& body) const {
    const Place matrix{"start", "matrix"};
    std::vector<Place> list = {{"par"}};
    if (has_coefficients_) list.push_back({"k"});
    if (weights_.uses_h()) list.push_back({"h"});
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
    body.push_back({SolveFactorised{matrix, {"start", "lack"}}});
  }

  [[nodiscard]] std::vector<UnknownArray> unknown_arrays(RoutineBuilder& b) const {
    std::vector<UnknownArray> list;
    for (const long first : {0, n_}) {
      if (first == unknowns()) break;
      const std::vector<AffineIndex> index = {affine("i", first)};
      list.push_back({.value = b.at("start", "value", index).name(),
                      .increment = b.at("start", "lack", index).name(),
                      .beside = state(b, "z", first == 0 ? "q" : "p")});
    }
    return list;
  }

  // Note [what the torn momenta lose]
  // They are rounded, at every step alike where the products that they are made of have a pattern,
  // and h m times that is missing in dq: two thirds of a bias of 1e-4 units of rounding a step.
  [[nodiscard]] bool knows_momentum_error() const {
    return settles() && !needs_drift() && arrays_.mass && arrays_.mass->is_number();
  }
  Expression lost_of_momentum(RoutineBuilder& b, Body& each) const {
    // In this order: z and bar cancel without an error.
    const Expression z = state(b, "z", "p");
    const Expression bar = b.local("bar");
    const Expression carry = state(b, "carry", "p");
    const Gradient at = {b.at("start", "refinement.slope", {affine("i")}), Expression(0)};
    const StageRow row = weights_.row_of_p(b, each, at);
    Expression sum = carry + row.small;
    for (const Expression& term : row.large) sum += term;
    const Expression moved = b.let(each, "moved", sum);
    each.push_back({Let{bar.name(), z + moved}});
    return z - bar + moved;
  }

  // dz = h J grad H at the stage, which Refinement has where the unknowns are a fixed point.
  void add_result(RoutineBuilder& b, bool refined) const {
    Return end{.ranges = {elements()}};
    Body each;
    for (const bool is_p : {false, true}) {
      const char* field = is_p ? "p" : "q";
      const int from = is_p ? 0 : n_;  // dH/dq moves p
      const Expression carry = state(b, "carry", field);
      const auto flow = [&](const char* of) {
        const Expression slope = step_size() * b.at("start", of, {affine("i", from)});
        return is_p ? -slope : slope;
      };
      const Expression dz = state(b, "dz", field);
      end.finite.push_back(dz.name());
      if (refined) {
        const Expression rest = state(b, "rest", field);
        each.push_back({Assign{dz.name(), flow("refinement.slope")}});
        Expression small = carry + flow("refinement.change");
        if (!is_p && knows_momentum_error()) {
          small += step_size() * *arrays_.mass * lost_of_momentum(b, each);
        }
        each.push_back({Assign{rest.name(), small}});
        end.finite.push_back(rest.name());
      } else {
        each.push_back({Assign{dz.name(), carry + flow("slope")}});
        if (both()) each.push_back({Assign{state(b, "rest", field).name(), Expression(0)}});
      }
    }
    b.body().push_back(for_each(elements(), std::move(each)));
    b.body().push_back({std::move(end)});
  }

  Program& code_;
  const Environment& environment_;
  const Mechanics& mechanics_;
  const SolvePlan& plan_;
  const ArrayPlan& arrays_;
  int n_;
  bool tangent_;
  StepWeights weights_;
  bool has_coefficients_ = false;
};

}  // namespace

void add_loop_member(Program& code, const Environment& environment, const LoweredStep& lowered) {
  LoopMember(code, environment, lowered).add();
}

}  // namespace hamgen
