// Tangent maps that solve linear equations: of implicit Runge-Kutta methods, and of members in
// loops.
#include "generator/program/loop_coefficients.hpp"
#include "generator/program/method_tangents.hpp"
#include "generator/program/step_weights.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

Routine stages_tangent(const Environment& environment, const LoweredStep& lowered,
                       const Program& code) {
  TangentBuilder b(environment, lowered, "tangent",
                   {"M = dZ/dz of one step: the matrix of Newton's iteration with the Hessian of "
                    "every stage."});
  const int n = b.n();
  const int size = 2 * n;
  const auto stages = static_cast<int>(lowered.sequence.stages.weight.size());
  add_step(b.body(), code, "h", "z");
  // second[i] = h b_i J H''(Y_i)
  b.body().push_back({Array{"second", {stages, size, size}}});
  b.body().push_back({Array{"unit", {size, size}}});
  b.body().push_back(b.set_unit("unit"));
  Body stage;
  stage.push_back({Array{"product", {size, size}}});
  Place point{"start", "value", {affine("i", 0, size)}};
  const StageLayout& layout = *lowered.stage_layout;
  if (layout.by_component()) {
    point = {"stage"};
    stage.push_back({Array{"stage", {size}}});
    const Expression value = b.at({"start", "value", {layout.index("i", 0, "row", 0)}});
    Body each{{Assign{b.at({"stage", "", {affine("row")}}).name(), value}}};
    stage.push_back(for_each(counting("row", size), std::move(each)));
  }
  b.multiply_hessian(stage, {point, false}, "unit", "product");
  const auto second = [&](const AffineIndex& row, const AffineIndex& column) {
    return b.at("second", "", {affine("i"), row, column});
  };
  const Expression scaled = b.at("k", "scaled", {affine("i")});
  Body turn;
  turn.push_back(
      {Assign{second(affine("row"), affine("column")).name(), scaled * b.entry("product", n)}});
  turn.push_back(
      {Assign{second(affine("row", n), affine("column")).name(), -scaled * b.entry("product")}});
  stage.push_back(b.for_rows(n, std::move(turn)));
  b.body().push_back(for_each(counting("i", stages), std::move(stage)));

  b.body().push_back({Matrix{.name = "matrix", .size = stages * size}});
  const AffineIndex line{0, {{"i", size}, {"row", 1}}};
  Body one{{Put{{"matrix"}, affine("row"), affine("row"), Expression(1)}}};
  b.body().push_back(for_each(counting("row", stages * size), std::move(one)));
  Body put{{Put{{"matrix"},
                line,
                {0, {{"j", size}, {"column", 1}}},
                -b.product({"k", "coupling",
                            layout.by_component() ? std::vector{affine("j"), affine("i")}
                                                  : std::vector{affine("i"), affine("j")}},
                           {"second", "", {affine("j"), affine("row"), affine("column")}})}}};
  Body pairs;
  Body columns;
  columns.push_back(b.for_entries(std::move(put)));
  pairs.push_back(for_each(counting("j", stages), std::move(columns)));
  b.body().push_back(for_each(counting("i", stages), std::move(pairs)));
  b.body().push_back({Factorise{{"matrix"}}});

  b.body().push_back(b.set_unit("m"));
  Body column;
  column.push_back({Array{"vector", {stages * size}}});
  const Expression displaced = b.at("vector", "", {{0, {{"i", size}, {"column", 1}}}});
  Body unit{{Assign{displaced.name(), Expression(1)}}};
  column.push_back(for_each(counting("i", stages), std::move(unit)));
  column.push_back({SolveFactorised{{"matrix"}, {"vector"}}});
  Body term{{Accumulate{b.entry("m").name(),
                        b.product({"second", "", {affine("i"), affine("row"), affine("l")}},
                                  {"vector", "", {{0, {{"i", size}, {"l", 1}}}}})}}};
  Body rows;
  Body inner;
  inner.push_back(for_each(counting("l", size), std::move(term)));
  rows.push_back(for_each(counting("row", size), std::move(inner)));
  column.push_back(for_each(counting("i", stages), std::move(rows)));
  b.body().push_back(for_each(counting("column", size), std::move(column)));
  b.finish();
  return b.take();
}

namespace {

// The solved members of a system in loops: a displacement u moves the stage by
// dzbar = u + h (I/2 + C) J H'' dzbar, and Z by u + h J H'' dzbar.
class LoopMemberTangent {
 public:
  LoopMemberTangent(const Environment& environment, const LoweredStep& lowered, const Program& code,
                    std::string name)
      : mechanics_(lowered.plan.equations.mechanics),
        arrays_(*lowered.plan.arrays),
        code_(code),
        weights_(*uniform_parameters(lowered.plan.equations.scheme.member())),
        b_(environment, lowered, std::move(name), {}),
        n_(b_.n()) {}

  Routine build() {
    switch (arrays_.method) {
      case ArrayMethod::explicit_a:
      case ArrayMethod::explicit_b:
        add_explicit(arrays_.method == ArrayMethod::explicit_a);
        break;
      default:
        add_solved();
        break;
    }
    b_.finish();
    return b_.take();
  }

 private:
  // A kick and a drift, or a drift and a kick; H'' at zbar has both blocks.
  void add_explicit(bool kick_first) {
    b_.routine().remark = {kick_first ? "M = dZ/dz: the kick's times the drift's."
                                      : "M = dZ/dz: the drift's times the kick's."};
    b_.body().push_back({Copy{"State", "bar", "z", true}});
    const char* moved = kick_first ? "p" : "q";
    Body move{{Accumulate{b_.at("bar", moved, {affine("row")}).name(),
                          b_.at("dz", moved, {affine("row")})}}};
    b_.body().push_back(for_each(counting("row", n_), std::move(move)));
    b_.body().push_back({Array{"product", {2 * n_, 2 * n_}}});
    b_.body().push_back(b_.set_unit("m"));
    for (const bool kick : {kick_first, !kick_first}) {
      b_.multiply_hessian(b_.body(), {{"bar"}}, "m", "product");
      const Expression size = kick ? -step_size() : step_size();
      Body each{{Accumulate{b_.entry("m", kick ? n_ : 0).name(),
                            size * b_.entry("product", kick ? 0 : n_)}}};
      b_.body().push_back(b_.for_rows(n_, std::move(each)));
    }
  }

  void add_solved() {
    b_.routine().remark = {
        "M = dZ/dz of the step that moves z by dz: a displacement u moves the "
        "stage by",
        "dzbar = u + h (I/2 + C) J H'' dzbar, and Z by u + h J H'' dzbar."};
    if (code_.record("Coefficients") != nullptr) b_.body().push_back(prepared({"h"}));
    add_stage();
    b_.body().push_back({Matrix{.name = "matrix", .size = code_.matrix->size, .patterned = true}});
    std::vector<Place> list;
    for (const Argument& argument : code_.routine("differentiate")->arguments) {
      list.push_back({argument.name});
    }
    b_.body().push_back(tangent_call("differentiate", std::move(list)));
    b_.body().push_back({Factorise{{"matrix"}}});
    Body column;
    const int unknowns = arrays_.reduced ? n_ : 2 * n_;
    column.push_back({Array{"u", {2 * n_}}});
    column.push_back({Assign{b_.at("u", "", {affine("column")}).name(), Expression(1)}});
    column.push_back({Array{"moved", {unknowns}}});
    Body right{{Assign{element("moved", 0).name(), right_side()}}};
    if (!arrays_.reduced) right.push_back({Assign{element("moved", n_).name(), element("u", n_)}});
    column.push_back(for_each(counting("row", n_), std::move(right)));
    column.push_back({Array{"y", {2 * n_}}});
    if (knows_time(mechanics_, weights_.member)) add_time(column);
    column.push_back({SolveFactorised{{"matrix"}, {"moved"}}});
    add_curvature(column);
    const Expression u_q = element("u", 0);
    const Expression u_p = element("u", n_);
    Body result;
    result.push_back({Assign{b_.entry("m").name(), u_q + step_size() * element("y", n_)}});
    result.push_back({Assign{b_.entry("m", n_).name(), u_p - step_size() * element("y", 0)}});
    column.push_back(for_each(counting("row", n_), std::move(result)));
    b_.body().push_back(for_each(counting("column", 2 * n_), std::move(column)));
  }

  Expression element(const char* array, long first) {
    return b_.at(array, "", {affine("row", first)});
  }

  // zbar = z + (I/2 + C) dz: q + alpha dq - gamma dp, p + (1 - alpha) dp - beta dq.
  void add_stage() {
    const auto& [alpha, beta, gamma] = weights_.member;
    b_.body().push_back({Array{"at", {2 * n_}}});
    const Expression q = b_.at("z", "q", {affine("row")});
    const Expression p = b_.at("z", "p", {affine("row")});
    const Expression dq = b_.at("dz", "q", {affine("row")});
    const Expression dp = b_.at("dz", "p", {affine("row")});
    Body each;
    each.push_back({Assign{element("at", 0).name(), q + alpha * dq - gamma * dp}});
    each.push_back(
        {Assign{element("at", n_).name(), p + (Expression(1) - alpha) * dp - beta * dq}});
    b_.body().push_back(for_each(counting("row", n_), std::move(each)));
  }

  [[nodiscard]] Expression mass() { return b_.at("k", "mass", loop_mass_index(arrays_, "row")); }
  // The displacement of a torn momentum: (u_p - h (1 - alpha) y) / (1 + h beta m), y = V'' dqbar.
  Expression torn(const Expression& value) {
    if (!weights_.p_by_p) return value;
    return value * Expression::power(Expression(1) + *weights_.p_by_p * mass(), Expression(-1));
  }
  Expression right_side() {
    weights_.bind(b_.routine());
    const Expression u = element("u", 0);
    if (!arrays_.reduced || !weights_.q_by_p) return u;
    const Expression own = mass();
    return u + *weights_.q_by_p * own * torn(element("u", n_));
  }

  // The matrix is without what t moves: moved -= (A e_t) u_t, but for the row of t.
  void add_time(Body& column) {
    const auto time = affine(n_ - 1);
    column.push_back({Array{"by_time", {2 * n_}}});
    column.push_back({Assign{b_.at("by_time", "", {time}).name(), b_.at("u", "", {time})}});
    column.push_back(b_.curvature({"at"}, {"at", "", {affine(n_)}}, {"by_time"}));
    const Expression y_q = element("y", 0);
    const Expression y_p = element("y", n_);
    Body each;
    if (arrays_.reduced) {
      const Expression scale = b_.at("k", "scale", loop_mass_index(arrays_, "row"));
      each.push_back({Accumulate{element("moved", 0).name(), -(scale * y_q)}});
    } else {
      weights_.bind(b_.routine());
      if (weights_.q_by_p)
        each.push_back({Accumulate{element("moved", 0).name(), *weights_.q_by_p * y_p}});
      Expression of_p;
      if (weights_.p_by_q) of_p += *weights_.p_by_q * y_q;
      if (weights_.p_by_p) of_p += *weights_.p_by_p * y_p;
      if (!of_p.is_zero()) each.push_back({Accumulate{element("moved", n_).name(), -of_p}});
    }
    column.push_back(for_each(counting("row", n_), std::move(each)));
  }

  void add_curvature(Body& column) {
    const Place q{"at"};
    const Place p{"at", "", {affine(n_)}};
    if (!arrays_.reduced) {
      column.push_back(b_.curvature(q, p, {"moved"}));
      return;
    }
    // H'' of the coordinates alone.
    column.push_back({Array{"whole", {2 * n_}}});
    Body copy{{Assign{element("whole", 0).name(), element("moved", 0)}}};
    column.push_back(for_each(counting("row", n_), std::move(copy)));
    column.push_back(b_.curvature(q, p, {"whole"}));
    Expression moved = element("u", n_);
    if (weights_.p_by_q) moved = moved - *weights_.p_by_q * element("y", 0);
    const Expression own = mass();
    Body momenta{{Assign{element("y", n_).name(), own * torn(moved)}}};
    column.push_back(for_each(counting("row", n_), std::move(momenta)));
  }

  const Mechanics& mechanics_;
  const ArrayPlan& arrays_;
  const Program& code_;
  StepWeights weights_;
  TangentBuilder b_;
  int n_;
};

}  // namespace

Routine loop_member_tangent(const Environment& environment, const LoweredStep& lowered,
                            const Program& code, std::string name) {
  return LoopMemberTangent(environment, lowered, code, std::move(name)).build();
}

}  // namespace hamgen
