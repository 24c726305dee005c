#include "generator/program/method_tangents.hpp"

#include <fmt/format.h>

#include "generator/program/splitting_routine.hpp"
#include "generator/program/stage_routines.hpp"
#include "generator/program/step_weights.hpp"

namespace hamgen {

namespace {

Instruction call(std::string routine, std::vector<Place> arguments) {
  return {Call{.routine = std::move(routine), .arguments = std::move(arguments)}};
}

Instruction prepared(Place h) {
  return {Call{.routine = "prepare",
               .arguments = {{"par"}, std::move(h)},
               .record = "Coefficients",
               .object = "k"}};
}

// --- splittings
// -----------------------------------------------------------------------------------

class SplittingTangent {
 public:
  SplittingTangent(const Environment& environment, const Program& program)
      : sequence_(program.sequence),
        b_(environment, program, "tangent",
           {"M = dZ/dz, the product over the substeps: a kick adds -b h V'' of its rows of",
            "coordinates to those of momenta, a drift a h T'' of these to those."}) {}

  Routine build() {
    const int n = b_.n();
    Body& body = b_.body();
    body.push_back(prepared({"h"}));
    body.push_back({Copy{"State", "now", "z", true}});
    body.push_back({Array{"slope", {n}}});
    body.push_back({Array{"product", {2 * n, 2 * n}}});
    body.push_back(b_.set_unit("m"));
    const bool kick_first = sequence_.substeps.front().kind == SubstepKind::kick;
    const auto pairs = static_cast<int>(sequence_.substeps.size() / 2);
    Body pair;
    const AffineIndex i = pairs == 1 ? AffineIndex{} : affine("i");
    add_substep(pair, kick_first, i);
    add_substep(pair, !kick_first, i);
    if (pairs == 1) {
      for (Instruction& instruction : pair) body.push_back(std::move(instruction));
    } else {
      body.push_back(for_each(counting("i", pairs), std::move(pair)));
    }
    if (is_closed(sequence_)) add_substep(body, kick_first, affine(pairs));
    b_.finish();
    return b_.take();
  }

 private:
  void add_substep(Body& body, bool kick, const AffineIndex& substep) {
    const int n = b_.n();
    b_.multiply_hessian(body, {{"now"}}, "m", "product");
    const Expression length = b_.at("k", kick ? "kick" : "drift", {substep});
    const Expression size = kick ? -length : length;
    const int to = kick ? n : 0;
    Body each{{Accumulate{b_.entry("m", to).name(), size * b_.entry("product", kick ? 0 : n)}}};
    body.push_back(b_.for_rows(n, std::move(each)));
    const char* routine = kick ? "potential_gradient" : "kinetic_gradient";
    if (b_.arrays()) {
      body.push_back(call(routine, {{"par"}, {"now", kick ? "q" : "p"}, {"slope"}}));
      Body move{{Accumulate{b_.at("now", kick ? "p" : "q", {affine("row")}).name(),
                            size * b_.at("slope", "", {affine("row")})}}};
      body.push_back(for_each(counting("row", n), std::move(move)));
      return;
    }
    body.push_back(call(routine, {{"par"}, {"k"}, {"now"}, {"slope"}}));
    for (int i = 0; i < n; ++i) {
      body.push_back({Accumulate{b_.at(b_.environment().place("now", to + i)).name(),
                                 size * b_.at("slope", "", {affine(i)})}});
    }
  }

  const Sequence& sequence_;
  TangentBuilder b_;
};

// A step of length h (a number of this name) from the state, which must succeed: dz, rest and
// `start` are its locals.
void add_step(Body& body, const StepCode& code, const std::string& h, const std::string& state) {
  const Routine& solve = *code.routine("solve");
  if (code.record("Coefficients") != nullptr) body.push_back(prepared({h}));
  Call step{.routine = "solve", .arguments = {}, .record = "StepReport", .must_succeed = true};
  for (const Argument& argument : solve.arguments) {
    const std::string& name = argument.name;
    if (name == "start") body.push_back({Copy{"Start", "start", "", true}});
    if (name == "carry" || name == "dz" || name == "rest") {
      body.push_back({Copy{"State", name == "dz" ? "moved" : name, "", true}});
    }
    step.arguments.push_back({name == "h"    ? h
                              : name == "z"  ? state
                              : name == "dz" ? "moved"
                                             : name});
  }
  body.push_back({std::move(step)});
}

}  // namespace

Routine splitting_tangent(const Environment& environment, const Program& program) {
  return SplittingTangent(environment, program).build();
}

Routine composition_tangent(const Environment& environment, const Program& program,
                            const StepCode& code) {
  TangentBuilder b(environment, program, "tangent", {"M = dZ/dz, the product over the substeps."});
  const int size = 2 * b.n();
  std::vector<Expression> lengths;
  for (const Rational& length : code.substeps) lengths.emplace_back(length);
  const auto count = static_cast<int>(lengths.size());
  b.body().push_back({Array{"lengths", {count}, std::move(lengths)}});
  b.body().push_back({Copy{"State", "now", "z", true}});
  b.body().push_back(b.set_unit("m"));
  Body substep;
  b.let(substep, "stride", step_size() * b.at("lengths", "", {affine("i")}));
  add_step(substep, code, "stride", "now");
  substep.push_back({Array{"factor", {size, size}}});
  substep.push_back({Call{.routine = "substep_tangent",
                          .arguments = {{"par"}, {"stride"}, {"now"}, {"moved"}, {"factor"}},
                          .must_succeed = true}});
  substep.push_back({Array{"product", {size, size}}});
  Body term{
      {Accumulate{b.entry("product").name(), b.at("factor", "", {affine("row"), affine("l")}) *
                                                 b.at("m", "", {affine("l"), affine("column")})}}};
  Body each;
  each.push_back(for_each(counting("l", size), std::move(term)));
  substep.push_back(b.for_entries(std::move(each)));
  Body copy{{Assign{b.entry("m").name(), b.entry("product")}}};
  substep.push_back(b.for_entries(std::move(copy)));
  b.add_increment(substep, "now", code.has_rest());
  b.body().push_back(for_each(counting("i", count), std::move(substep)));
  b.finish();
  return b.take();
}

Routine explicit_runge_kutta_tangent(const Environment& environment, const Program& program) {
  const StageTable& table = program.sequence.stages;
  TangentBuilder b(environment, program, "tangent",
                   {"M = dZ/dz = 1 + h sum b_i K_i with K_i = J H''(Y_i) (1 + h sum a_ij K_j)."});
  const int n = b.n();
  const int size = 2 * n;
  b.body().push_back({Array{"x", {size}}});
  read_state(b, b.body(), environment, "z", {"x"}, b.arrays());
  b.body().push_back({Array{"stage", {size}}});
  b.body().push_back({Array{"moved", {size, size}}});
  b.body().push_back({Array{"product", {size, size}}});
  b.body().push_back(b.set_unit("m"));
  const auto slope = [](std::size_t j) { return fmt::format("f_{}", j + 1); };
  const auto map = [](std::size_t j) { return fmt::format("map_{}", j + 1); };
  for (std::size_t i = 0; i < table.weight.size(); ++i) {
    Body move;
    Body widen;
    Expression sum(0);
    Expression maps(0);
    for (std::size_t j = 0; j < i; ++j) {
      const Expression a(numeric_value(table.coupling[i][j]));
      if (a.is_zero()) continue;
      sum += a * b.at(slope(j), "", {affine("j")});
      maps += a * b.entry(map(j));
    }
    move.push_back({Assign{b.at("stage", "", {affine("j")}).name(),
                           b.at("x", "", {affine("j")}) + step_size() * sum}});
    b.body().push_back(for_each(counting("j", size), std::move(move)));
    b.body().push_back(b.set_unit("moved"));
    if (!maps.is_zero()) {
      widen.push_back({Accumulate{b.entry("moved").name(), step_size() * maps}});
      b.body().push_back(b.for_entries(std::move(widen)));
    }
    b.body().push_back({Array{slope(i), {size}}});
    b.body().push_back(call("vector_field", {{"par"}, {"stage"}, {slope(i)}}));
    b.multiply_hessian(b.body(), {{"stage"}, false}, "moved", "product");
    b.body().push_back({Array{map(i), {size, size}}});
    const Expression weight = step_size() * Expression(numeric_value(table.weight[i]));
    Body turn;
    turn.push_back({Assign{b.entry(map(i)).name(), b.entry("product", n)}});
    turn.push_back({Assign{b.entry(map(i), n).name(), -b.entry("product")}});
    turn.push_back({Accumulate{b.entry("m").name(), weight * b.entry(map(i))}});
    turn.push_back({Accumulate{b.entry("m", n).name(), weight * b.entry(map(i), n)}});
    b.body().push_back(b.for_rows(n, std::move(turn)));
  }
  b.finish();
  return b.take();
}

Routine stages_tangent(const Environment& environment, const Program& program,
                       const StepCode& code) {
  TangentBuilder b(environment, program, "tangent",
                   {"M = dZ/dz of one step: the matrix of Newton's iteration with the Hessian of "
                    "every stage."});
  const int n = b.n();
  const int size = 2 * n;
  const auto stages = static_cast<int>(program.sequence.stages.weight.size());
  add_step(b.body(), code, "h", "z");
  // second[i] = h b_i J H''(Y_i)
  b.body().push_back({Array{"second", {stages, size, size}}});
  b.body().push_back({Array{"unit", {size, size}}});
  b.body().push_back(b.set_unit("unit"));
  Body stage;
  stage.push_back({Array{"product", {size, size}}});
  b.multiply_hessian(stage, {{"start", "value", {affine("i", 0, size)}}, false}, "unit", "product");
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
                -b.at("k", "coupling", {affine("i"), affine("j")}) *
                    b.at("second", "", {affine("j"), affine("row"), affine("column")})}}};
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
                        b.at("second", "", {affine("i"), affine("row"), affine("l")}) *
                            b.at("vector", "", {{0, {{"i", size}, {"l", 1}}}})}}};
  Body rows;
  Body inner;
  inner.push_back(for_each(counting("l", size), std::move(term)));
  rows.push_back(for_each(counting("row", size), std::move(inner)));
  column.push_back(for_each(counting("i", stages), std::move(rows)));
  b.body().push_back(for_each(counting("column", size), std::move(column)));
  b.finish();
  return b.take();
}

// h (I/2 + C) J applied to a vector, as 2n rows of terms: `vector` gives its components.
namespace {

using Vector = std::function<Expression(const AffineIndex&)>;

// Row i of h (I/2 + C) J v of a system that is written out.
Expression written_row(const Member& member, int n, int i, const Vector& v) {
  Expression sum(0);
  const auto add = [&](int k, const Expression& weight) {
    const Expression turned = k < n ? v(affine(k + n)) : -v(affine(k - n));
    sum += step_size() * weight * turned;
  };
  add(i, Expression(Rational(1, 2)));
  for (const auto& [place, value] : member.c) {
    if (place.first == i) add(place.second, value);
  }
  return sum;
}

// Rows "row" and n + "row" of the same of one in loops.
Expression loop_row(const FamilyParameters& member, int n, bool momentum, const Vector& v) {
  const Expression by_q = v(affine("row"));
  const Expression by_p = v(affine("row", n));
  const Expression h = step_size();
  if (momentum) return -(h * (Expression(1) - member.alpha)) * by_q - h * member.beta * by_p;
  return h * member.alpha * by_p + h * member.gamma * by_q;
}

// m = 1 + h J dg
void add_flow(TangentBuilder& b, const std::string& derivative) {
  const int n = b.n();
  b.body().push_back(b.set_unit("m"));
  Body turn;
  turn.push_back({Accumulate{b.entry("m").name(), step_size() * b.entry(derivative, n)}});
  turn.push_back({Accumulate{b.entry("m", n).name(), -step_size() * b.entry(derivative)}});
  b.body().push_back(b.for_rows(n, std::move(turn)));
}

}  // namespace

Routine sweeps_tangent(const Environment& environment, const Program& program, std::string name) {
  const Member& member = program.plan.equations.scheme.member();
  TangentBuilder b(environment, program, std::move(name),
                   {"M = dZ/dz of the sweeps themselves, each linearised: g and its derivative dg "
                    "along z are carried",
                    "through zbar = z + h (I/2 + C) J g and g = grad H(zbar)."});
  const int n = b.n();
  const int size = 2 * n;
  const auto row = [&](int i, const Vector& v) {
    return b.arrays() ? loop_row(*uniform_parameters(member), n, i >= n, v)
                      : written_row(member, n, i, v);
  };
  b.body().push_back({Array{"g", {size}}});
  b.body().push_back({Array{"dg", {size, size}}});
  b.body().push_back({Array{"moved", {size, size}}});
  b.body().push_back({Copy{"State", "bar", "z", true}});
  b.body().push_back(b.set_unit("moved"));
  b.add_gradient(b.body(), {{"bar"}}, "g");
  b.multiply_hessian(b.body(), {{"bar"}}, "moved", "dg");
  Body sweep;
  b.for_components(
      sweep, [&](Body& to, const TangentBuilder::Component& of, const AffineIndex& index) {
        const int i = index.factors.empty() ? static_cast<int>(index.constant)
                                            : (index.constant == 0 ? 0 : n);
        to.push_back({Assign{of("bar").name(), of("z") + row(i, [&](const AffineIndex& k) {
                                                 return b.at("g", "", {k});
                                               })}});
      });
  sweep.push_back(b.set_unit("moved"));
  Body columns;
  const auto widen = [&](Body& to, int i, const AffineIndex& index) {
    to.push_back({Accumulate{b.at("moved", "", {index, affine("column")}).name(),
                             row(i, [&](const AffineIndex& k) {
                               return b.at("dg", "", {k, affine("column")});
                             })}});
  };
  if (b.arrays()) {
    Body rows;
    widen(rows, 0, affine("row"));
    widen(rows, n, affine("row", n));
    columns.push_back(for_each(counting("row", n), std::move(rows)));
  } else {
    for (int i = 0; i < size; ++i) widen(columns, i, affine(i));
  }
  sweep.push_back(for_each(counting("column", size), std::move(columns)));
  b.add_gradient(sweep, {{"bar"}}, "g");
  b.multiply_hessian(sweep, {{"bar"}}, "moved", "dg");
  b.body().push_back(for_each(counting("sweep", *program.plan.sweeps), std::move(sweep)));
  add_flow(b, "dg");
  b.finish();
  return b.take();
}

namespace {

// The solved members of a system in loops: a displacement u moves the stage by
// dzbar = u + h (I/2 + C) J H'' dzbar, and Z by u + h J H'' dzbar.
class LoopMemberTangent {
 public:
  LoopMemberTangent(const Environment& environment, const Program& program, const StepCode& code,
                    std::string name)
      : arrays_(*program.plan.arrays),
        code_(code),
        weights_(*uniform_parameters(program.plan.equations.scheme.member())),
        b_(environment, program, std::move(name), {}),
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
    b_.body().push_back(call("differentiate", std::move(list)));
    b_.body().push_back({Factorise{{"matrix"}}});
    Body column;
    const int unknowns = arrays_.reduced ? n_ : 2 * n_;
    column.push_back({Array{"u", {2 * n_}}});
    column.push_back({Assign{b_.at("u", "", {affine("column")}).name(), Expression(1)}});
    column.push_back({Array{"moved", {unknowns}}});
    Body right{{Assign{element("moved", 0).name(), right_side()}}};
    if (!arrays_.reduced) right.push_back({Assign{element("moved", n_).name(), element("u", n_)}});
    column.push_back(for_each(counting("row", n_), std::move(right)));
    column.push_back({SolveFactorised{{"matrix"}, {"moved"}}});
    column.push_back({Array{"y", {2 * n_}}});
    add_curvature(column);
    Body result;
    result.push_back(
        {Assign{b_.entry("m").name(), element("u", 0) + step_size() * element("y", n_)}});
    result.push_back(
        {Assign{b_.entry("m", n_).name(), element("u", n_) - step_size() * element("y", 0)}});
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

  [[nodiscard]] Expression mass() {
    return b_.at("k", "mass",
                 arrays_.mass ? std::vector<AffineIndex>{} : std::vector{affine("row")});
  }
  // The displacement of a torn momentum: (u_p - h (1 - alpha) y) / (1 + h beta m), y = V'' dqbar.
  Expression torn(const Expression& value) {
    if (!weights_.p_by_p) return value;
    return value * Expression::power(Expression(1) + *weights_.p_by_p * mass(), Expression(-1));
  }
  Expression right_side() {
    weights_.bind(b_.routine());
    const Expression u = element("u", 0);
    if (!arrays_.reduced || !weights_.q_by_p) return u;
    return u + *weights_.q_by_p * mass() * torn(element("u", n_));
  }

  void add_curvature(Body& column) {
    const Place q{"at"};
    const Place p{"at", "", {affine(n_)}};
    if (!arrays_.reduced) {
      column.push_back(call("curvature", {{"par"}, q, p, {"moved"}, {"y"}}));
      return;
    }
    // H'' of the coordinates alone.
    column.push_back({Array{"whole", {2 * n_}}});
    Body copy{{Assign{element("whole", 0).name(), element("moved", 0)}}};
    column.push_back(for_each(counting("row", n_), std::move(copy)));
    column.push_back(call("curvature", {{"par"}, q, p, {"whole"}, {"y"}}));
    Expression moved = element("u", n_);
    if (weights_.p_by_q) moved = moved - *weights_.p_by_q * element("y", 0);
    Body momenta{{Assign{element("y", n_).name(), mass() * torn(moved)}}};
    column.push_back(for_each(counting("row", n_), std::move(momenta)));
  }

  const ArrayPlan& arrays_;
  const StepCode& code_;
  StepWeights weights_;
  TangentBuilder b_;
  int n_;
};

}  // namespace

Routine loop_member_tangent(const Environment& environment, const Program& program,
                            const StepCode& code, std::string name) {
  return LoopMemberTangent(environment, program, code, std::move(name)).build();
}

}  // namespace hamgen
