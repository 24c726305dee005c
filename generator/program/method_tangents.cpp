#include "generator/program/method_tangents.hpp"

#include <fmt/format.h>

#include "generator/program/runge_kutta_routine.hpp"
#include "generator/program/splitting_routine.hpp"
#include "generator/program/stage_routines.hpp"
#include "generator/program/step_weights.hpp"

namespace hamgen {

namespace {

class SplittingTangent {
 public:
  SplittingTangent(const Environment& environment, const LoweredStep& lowered)
      : sequence_(lowered.sequence),
        b_(environment, lowered, "tangent",
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
      body.push_back(tangent_call(routine, {{"par"}, {"now", kick ? "q" : "p"}, {"slope"}}));
      Body move{{Accumulate{b_.at("now", kick ? "p" : "q", {affine("row")}).name(),
                            size * b_.at("slope", "", {affine("row")})}}};
      body.push_back(for_each(counting("row", n), std::move(move)));
      return;
    }
    body.push_back(tangent_call(routine, {{"par"}, {"k"}, {"now"}, {"slope"}}));
    for (int i = 0; i < n; ++i) {
      body.push_back({Accumulate{b_.at(b_.environment().place("now", to + i)).name(),
                                 size * b_.at("slope", "", {affine(i)})}});
    }
  }

  const Sequence& sequence_;
  TangentBuilder b_;
};

}  // namespace

Routine splitting_tangent(const Environment& environment, const LoweredStep& lowered) {
  return SplittingTangent(environment, lowered).build();
}

Routine composition_tangent(const Environment& environment, const LoweredStep& lowered,
                            const Program& code) {
  TangentBuilder b(environment, lowered, "tangent", {"M = dZ/dz, the product over the substeps."});
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
  if (code.has_rest()) b.add_increment(substep, "moved", "rest");
  substep.push_back({Array{"factor", {size, size}}});
  substep.push_back({Call{.routine = "substep_tangent",
                          .arguments = {{"par"}, {"stride"}, {"now"}, {"moved"}, {"factor"}},
                          .must_succeed = true}});
  substep.push_back({Array{"product", {size, size}}});
  Body term{{Accumulate{b.entry("product").name(),
                        b.product({"factor", "", {affine("row"), affine("l")}},
                                  {"m", "", {affine("l"), affine("column")}})}}};
  Body each;
  each.push_back(for_each(counting("l", size), std::move(term)));
  substep.push_back(b.for_entries(std::move(each)));
  Body copy{{Assign{b.entry("m").name(), b.entry("product")}}};
  substep.push_back(b.for_entries(std::move(copy)));
  b.add_increment(substep, "now", "moved");
  b.body().push_back(for_each(counting("i", count), std::move(substep)));
  b.finish();
  return b.take();
}

Routine explicit_runge_kutta_tangent(const Environment& environment, const LoweredStep& lowered) {
  const StageTable& table = lowered.sequence.stages;
  TangentBuilder b(environment, lowered, "tangent",
                   {"M = dZ/dz = 1 + h sum b_i K_i with K_i = J H''(Y_i) (1 + h sum a_ij K_j)."});
  const int n = b.n();
  const int size = 2 * n;
  b.body().push_back({Array{"x", {size}}});
  read_state(b, b.body(), environment, "z", {"x"}, b.arrays());
  b.body().push_back({Array{"stage", {size}}});
  b.body().push_back({Array{"moved", {size, size}}});
  b.body().push_back({Array{"product", {size, size}}});
  b.body().push_back(b.set_unit("m"));
  const auto slope = explicit_slope;
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
    const Expression x = b.at("x", "", {affine("j")});
    move.push_back({Assign{b.at("stage", "", {affine("j")}).name(), x + step_size() * sum}});
    b.body().push_back(for_each(counting("j", size), std::move(move)));
    b.body().push_back(b.set_unit("moved"));
    if (!maps.is_zero()) {
      widen.push_back({Accumulate{b.entry("moved").name(), step_size() * maps}});
      b.body().push_back(b.for_entries(std::move(widen)));
    }
    b.body().push_back({Array{slope(i), {size}}});
    b.body().push_back(tangent_call("vector_field", {{"par"}, {"stage"}, {slope(i)}}));
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

Routine sweeps_tangent(const Environment& environment, const LoweredStep& lowered,
                       std::string name) {
  const Member& member = lowered.plan.equations.scheme.member();
  TangentBuilder b(environment, lowered, std::move(name),
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
  b.for_components(sweep, [&](Body& to, const TangentBuilder::Component& of,
                              const AffineIndex& index) {
    const int i =
        index.factors.empty() ? static_cast<int>(index.constant) : (index.constant == 0 ? 0 : n);
    const Expression z = of("z");
    to.push_back({Assign{of("bar").name(),
                         z + row(i, [&](const AffineIndex& k) { return b.at("g", "", {k}); })}});
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
  b.body().push_back(for_each(counting("sweep", *lowered.plan.sweeps), std::move(sweep)));
  add_flow(b, "dg");
  b.finish();
  return b.take();
}

}  // namespace hamgen
