#include "generator/program/stage_routines.hpp"

#include "generator/program/refinement_type.hpp"
#include "generator/program/runge_kutta_routine.hpp"
#include "generator/program/stage_coordinates.hpp"
#include "generator/program/stage_matrix.hpp"
#include "generator/program/stage_numbers.hpp"
#include "generator/program/state_rounding.hpp"

namespace hamgen {

namespace {

class StageRoutines : StageParts {
 public:
  StageRoutines(Program& code, const Environment& environment, const LoweredStep& lowered)
      : StageParts(lowered),
        code_(code),
        environment_(environment),
        lowered_(lowered),
        solver_(*lowered.plan.stage_solver),
        matrix_(lowered),
        beside_(stages_rounded_beside(lowered)) {
    if (lowered.second_order) coordinates_.emplace(environment, lowered);
  }

  void add() {
    Coefficients coefficients = stage_coefficients(environment_, lowered_);
    code_.records.push_back(std::move(coefficients.record));
    code_.routines.push_back(std::move(coefficients.prepare));
    code_.records.push_back(start());
    code_.routines.push_back(evaluate());
    if (coordinates_) {
      for (Routine& routine : coordinates_->routines())
        code_.routines.push_back(std::move(routine));
    }
    if (has_newton()) code_.routines.push_back(matrix_.differentiate());
    if (solver_ == StageSolver::both) {
      code_.routines.push_back(fixed_point());
      code_.routines.push_back(newton());
    }
    code_.routines.push_back(solve());
    if (has_newton()) {
      code_.matrix = ArrayMatrix{.kind = MatrixKind::dense, .size = matrix_.size()};
    }
  }

 private:
  // The unknowns of the iteration, the coordinates alone where the momenta are eliminated.
  [[nodiscard]] int iterated() const { return coordinates_ ? coordinates() : unknowns(); }
  [[nodiscard]] const char* evaluation() const {
    return coordinates_ ? "evaluate_coordinates" : "evaluate";
  }
  [[nodiscard]] bool has_newton() const { return solver_ != StageSolver::fixed_point; }
  [[nodiscard]] bool has_fixed_point() const { return solver_ != StageSolver::newton; }

  [[nodiscard]] Record start() const {
    Record record{
        .name = "Start",
        .fields = {},
        .remark = {by_component() ? "Of every component its numbers at all stages, and what is "
                                    "remembered of them."
                                  : "The stages, one after the other, and what is remembered of "
                                    "them."}};
    const auto array = [&](const char* name, int size, const char* remark) {
      record.fields.push_back({.name = name, .sizes = {size}, .remark = remark});
    };
    if (by_component()) {
      array("state", unknowns(), "z, at every stage");
    } else {
      array("state", dimension_, "z as an array");
    }
    if (beside_) beside_->add_fields(record, states());
    array("small", dimension_, "the carry");
    array("value", unknowns(), "Y_i");
    array("slope", unknowns(), "L_i = h b_i f(Y_i)");
    if (coordinates_) record.fields.push_back(coordinates_->base());
    record.fields.push_back(
        {.name = "known", .remark = "L_i are of the step before", .values = {0}, .type = "bool"});
    array("lack", unknowns(), "of the equations at Y_i, then the increment");
    if (has_newton()) {
      for (Field& field : matrix_.fields()) record.fields.push_back(std::move(field));
    }
    if (has_fixed_point()) {
      const bool impatient = solver_ == StageSolver::both;
      record.fields.push_back(
          {.name = "rule", .type = std::string(impatient ? "ImpatientRule" : lowered_.plan.rule)});
    }
    if (has_newton()) {
      record.fields.push_back({.name = "newton", .type = "SimplifiedNewtonRule"});
      record.fields.push_back({.name = "matrix", .type = "Matrix"});
      record.fields.push_back({.name = "factorised", .values = {0}, .type = "bool"});
      record.fields.push_back({.name = "residual"});
    }
    if (solver_ == StageSolver::both) {
      record.fields.push_back(
          {.name = "patience", .remark = "steps left to Newton", .values = {0}, .type = "int"});
    }
    std::string refinement =
        refinement_type(iterated(), unknowns(), beside_.has_value(), coordinates_.has_value());
    if (layout_.packs() > 0) refinement = "RefinementInLanes<Lanes, " + refinement + ">";
    record.fields.push_back({.name = "refinement", .type = std::move(refinement)});
    return record;
  }

  // --- routines ---------------------------------------------------------------------------------

  [[nodiscard]] Routine evaluate() const {
    RoutineBuilder b({.name = "evaluate",
                      .remark = {"L_i at the stages, and what these lack of z + sum coupling L."},
                      .arguments = with_start(false)});
    add_slopes(b);
    Body each;
    const Expression from = state(b);
    const Expression value = of_start(b, "value", row());
    // Term after term: the difference cancels with them, and what is left loses less than a sum of
    // them would.  At h = 0.3, where L_i are twelfths, that sum had the form of a chain of 6 drift
    // by 1.2e-3 units of rounding a step of gauss-6.
    const Expression moved = combination(b, "coupling");
    const Expression small = of_start(b, "small", affine("j"));
    each.push_back({Assign{of_start(b, "lack", row()).name(), from - value + moved + small}});
    b.body().push_back(for_all(std::move(each)));
    return b.take();
  }

  void add_slopes(RoutineBuilder& b) const {
    const Expression slope = of_start(b, "slope", row());
    Body scale{{Assign{slope.name(), scaled(b, slope)}}};
    if (by_component()) {
      b.body().push_back({Call{.routine = "vector_fields",
                               .arguments = {{"par"}, {"start", "value"}, {"start", "slope"}}}});
      b.body().push_back(for_all(std::move(scale)));
      return;
    }
    const AffineIndex first = affine("i", 0, dimension_);
    Body stage;
    stage.push_back(
        {Call{.routine = "vector_field",
              .arguments = {{"par"}, {"start", "value", {first}}, {"start", "slope", {first}}}}});
    stage.push_back(for_each(all_components(), std::move(scale)));
    b.body().push_back(for_each(all_stages(), std::move(stage)));
  }

  [[nodiscard]] IterateArray iteration(RoutineBuilder& b, Rule rule, Body body) const {
    const AffineIndex place = by_component() ? affine("j") : row();
    IterateArray iterate{.rule = rule,
                         .name = rule == Rule::fixed_point ? "rule" : "newton",
                         .ranges = {all_stages(), all_components()},
                         .unknowns = {{.value = of_start(b, "value", place).name(),
                                       .increment = of_start(b, "lack", place).name(),
                                       .beside = of_start(b, rounded(), affine("j"))}},
                         .body = std::move(body)};
    if (by_component()) {
      iterate.ranges = {counting("j", iterated())};
      iterate.lanes = layout_.packs();
    }
    if (rule == Rule::fixed_point) return iterate;
    iterate.factorised = Place{"start", "factorised"};
    iterate.residual = b.at("start", "residual").name();
    return iterate;
  }

  void add_fixed_point(RoutineBuilder& b) const {
    Body body{{call(evaluation())}};
    add_iteration(b, iteration(b, Rule::fixed_point, std::move(body)));
  }
  void add_iteration(RoutineBuilder& b, IterateArray iterate) const {
    if (coordinates_) b.body().push_back({call("begin_coordinates")});
    b.body().push_back({std::move(iterate)});
    if (coordinates_) b.body().push_back({call("end_coordinates")});
  }

  // One elimination serves until it contracts slowly, over many steps.
  void add_newton(RoutineBuilder& b) const {
    const Place flag{"start", "factorised"};
    const Place matrix{"start", "matrix"};
    Body fresh;
    fresh.push_back({call("differentiate")});
    fresh.push_back({Factorise{matrix}});
    fresh.push_back({SetFlag{flag, true}});
    Body body{{call(evaluation())}};
    body.push_back({If{flag, false, std::move(fresh)}});
    const Expression residual = b.at("start", "residual");
    body.push_back({Assign{residual.name(), Expression(0)}});
    Body size{{Accumulate{residual.name(),
                          Expression::apply("abs", {of_start(b, "lack", affine("j"))})}}};
    body.push_back(for_each(counting("j", iterated()), std::move(size)));
    matrix_.add_elimination(b, body);
    add_iteration(b, iteration(b, Rule::simplified_newton, std::move(body)));
  }

  [[nodiscard]] Routine fixed_point() const {
    RoutineBuilder b({.name = "fixed_point",
                      .remark = {"False if it contracts slowly or not at all."},
                      .result = {.type = "bool"},
                      .arguments = with_start(true)});
    add_fixed_point(b);
    b.body().push_back({Return{}});
    return b.take();
  }
  [[nodiscard]] Routine newton() const {
    RoutineBuilder b({.name = "newton",
                      .remark = {"Newton with a matrix that serves until it contracts slowly, over "
                                 "many steps."},
                      .result = {.type = "bool"},
                      .arguments = with_start(true)});
    add_newton(b);
    b.body().push_back({Return{}});
    return b.take();
  }

  // Of these arrays: of coordinates, then of momenta where these are unknowns.
  [[nodiscard]] int states() const { return by_component() ? iterated() : dimension_; }
  [[nodiscard]] const char* rounded() const { return beside_ ? "beside" : "state"; }

  // The stages of the polynomial through those of the last step, or the state.
  void add_start_values(RoutineBuilder& b) const {
    if (by_component()) {
      add_state_at_stages(b);
    } else {
      read_state(b, b.body(), environment_, "z", {"start", "state"}, is_array());
    }
    if (beside_) {
      const int count = coordinates_ ? states() : states() / 2;
      add_rounding(b, *beside_,
                   {.each = counting("j", count),
                    .q = of_start(b, "state", affine("j")),
                    .p = of_start(b, "state", affine("j", count)),
                    .beside_q = of_start(b, "beside", affine("j")),
                    .beside_p = of_start(b, "beside", affine("j", count)),
                    .times = by_component() ? layout_.room() : 1});
    }
    read_state(b, b.body(), environment_, "carry", {"start", "small"}, is_array());
    const Place known{"start", "known"};
    Body ahead;
    Body each;
    const Expression from = state(b);
    const Expression moved = b.let(each, "moved", combination(b, "ahead"));
    each.push_back({Assign{of_start(b, "value", row()).name(), from + moved}});
    ahead.push_back(for_all(std::move(each)));
    b.body().push_back({If{known, true, std::move(ahead)}});
    b.body().push_back({If{known, false, at_state(b)}});
    b.body().push_back({SetFlag{known, false}});
  }
  void add_state_at_stages(RoutineBuilder& b) const {
    Body each;
    if (is_array()) {
      for (const char* half : {"q", "p"}) {
        const Expression target = state(b, half[0] == 'q' ? 0 : n_);
        each.push_back({Assign{target.name(), b.at("z", half, {affine("j")})}});
      }
      b.body().push_back(for_all(std::move(each), n_));
      return;
    }
    for (int c = 0; c < dimension_; ++c) {
      const Expression target = of_start(b, "state", layout_.index("i", 0, "", c));
      each.push_back({Assign{target.name(), b.at(environment_.place("z", c))}});
    }
    b.body().push_back(in_lanes(all_stages(), layout_.packs(), std::move(each)));
  }
  [[nodiscard]] Body at_state(RoutineBuilder& b) const {
    Body all;
    if (by_component()) {
      const std::string value = of_start(b, "value", affine("j")).name();
      Body each{{Assign{value, of_start(b, "state", affine("j"))}}};
      all.push_back(for_each(counting("j", unknowns()), std::move(each)));
      return all;
    }
    Body each{{Assign{of_start(b, "value", row()).name(), of_start(b, "state", affine("j"))}}};
    all.push_back(for_all(std::move(each)));
    return all;
  }

  [[nodiscard]] Routine solve() const {
    RoutineBuilder b({.name = "solve",
                      .remark = {"dz + rest = Z - z for one step from z + carry; rest is small."},
                      .result = {.type = "StepReport", .object = "report"},
                      .arguments = {parameters_argument(),
                                    {.name = "k", .record = "Coefficients"},
                                    state_argument("z"),
                                    state_argument("carry"),
                                    {.name = "start", .record = "Start", .changes = true},
                                    state_argument("dz", true),
                                    state_argument("rest", true)}});
    add_start_values(b);
    switch (solver_) {
      case StageSolver::fixed_point:
        add_fixed_point(b);
        break;
      case StageSolver::newton:
        add_newton(b);
        break;
      case StageSolver::both:
        b.body().push_back(
            {Alternate{.first = call("fixed_point", true),
                       .second = call("newton", true),
                       .patience = {"start", "patience"},
                       .steps = kStepsOfNewton,
                       .between = at_state(b)},
             {"Newton where the fixed point contracts slowly, from the state too, and then for 32 "
              "steps."}});
        break;
    }
    add_refinement(b);
    add_result(b);
    return b.take();
  }

  void add_refinement(RoutineBuilder& b) const {
    RefineArray refine{.refinement = {"start", "refinement"},
                       .point = {"start", "value"},
                       .lack = {"start", "lack"},
                       .gradient = {"start", "slope"},
                       .count = iterated(),
                       .components = unknowns()};
    if (beside_) refine.beside = refined_length(b);
    refine.steps = solver_ == StageSolver::both ? kStepsOfNewton : 0;
    if (refine.steps > 0) refine.patience = {"start", "patience"};
    const auto contract = [&](Body& body) {
      if (!has_newton()) return;
      Body multiply;
      matrix_.add_elimination(b, multiply);
      body.push_back({If{{"start", "factorised"}, true, std::move(multiply)}});
    };
    if (coordinates_) {
      // What the rounded stages lack takes all of their equations, what it changes by when the
      // coordinates move takes theirs alone.
      refine.first = {{call("evaluate")}, {call("eliminate_momenta")}};
      contract(refine.first);
    }
    refine.body = {{call(evaluation())}};
    contract(refine.body);
    b.body().push_back({std::move(refine), {kRefinementRemark}});
    if (coordinates_) b.body().push_back({call("end_refinement")});
  }

  void add_result(RoutineBuilder& b) const {
    Return end{.flag = Place{"start", "known"}};
    Body each;
    const int components = is_array() ? 2 : dimension_;
    for (int c = 0; c < components; ++c) {
      // Of a system in loops the elements of q, then those of p.
      const auto index = [&](int stage) {
        return is_array() ? layout_.index("", stage, "j", c == 0 ? 0 : n_)
                          : affine(layout_.at(stage, c));
      };
      const auto component = [&](const char* state) {
        if (!is_array()) return b.at(environment_.place(state, c));
        return b.at(state, c == 0 ? "q" : "p", {affine("j")});
      };
      const std::string dz = component("dz").name();
      const std::string rest = component("rest").name();
      end.finite.insert(end.finite.end(), {dz, rest});
      // Without room for stages that are none.
      if (layout_.packs() > 0 && layout_.room() == stages_) {
        each.push_back({Assign{rest, component("carry")}});
        each.push_back({CollectStages{
            dz, rest, {"start", "refinement"}, index(0), layout_.room(), layout_.packs()}});
        continue;
      }
      Expression changes = component("carry");
      for (int m = 0; m < stages_; ++m) changes += of_start(b, "refinement.change", index(m));
      each.push_back({Assign{dz, of_start(b, "refinement.slope", index(0))}});
      each.push_back({Assign{rest, changes}});
      // Slopes are products with constants: what is rounded off their sum is a bias.
      for (int m = 1; m < stages_; ++m)
        each.push_back({Collect{dz, rest, of_start(b, "refinement.slope", index(m))}});
    }
    if (is_array()) {
      end.ranges = {counting("j", n_)};
      b.body().push_back(for_each(counting("j", n_), std::move(each)));
    } else {
      for (Instruction& instruction : each) b.body().push_back(std::move(instruction));
    }
    // The slopes that the next step starts from.
    const Expression slope = of_start(b, "slope", affine("j"));
    Body keep{{Assign{slope.name(), of_start(b, "refinement.slope", affine("j"))}}};
    b.body().push_back(for_each(counting("j", unknowns()), std::move(keep)));
    b.body().push_back({std::move(end)});
  }

  [[nodiscard]] bool is_array() const { return lowered_.plan.arrays.has_value(); }

  Program& code_;
  const Environment& environment_;
  const LoweredStep& lowered_;
  StageSolver solver_;
  StageMatrix matrix_;
  std::optional<StateRounding> beside_;
  std::optional<StageCoordinates> coordinates_;
};

}  // namespace

void add_stages(Program& code, const Environment& environment, const LoweredStep& lowered) {
  StageRoutines(code, environment, lowered).add();
}

}  // namespace hamgen
