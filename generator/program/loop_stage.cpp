#include "generator/program/loop_stage.hpp"

#include "generator/program/kernel_routines.hpp"
#include "generator/program/lower.hpp"
#include "generator/solvers/array_matrix.hpp"

namespace hamgen {

namespace {

// What z + carry + row lacks of bar: z, bar and what is large cancel without an error, and come
// first; what is small is one number.
Expression lacking(RoutineBuilder& b, Body& body, const Expression& z, const Expression& bar,
                   const Expression& carry, const StageRow& row, const std::string& small) {
  Expression sum = z - bar;
  for (const Expression& term : row.large) sum += term;
  if (row.large.empty()) return sum;
  return sum + (row.small.is_zero() ? carry : b.let(body, small, carry + row.small));
}

// z + (carry + row), what is small first; z alone where nothing moves it.
Expression moved(RoutineBuilder& b, Body& body, const Expression& z, const Expression& carry,
                 const StageRow& row, const std::string& change) {
  if (row.large.empty()) return z;
  const std::string small = std::string(change, 0, change.find("change")) + "small";
  return z + b.let(body, change, sum_of_row(b, body, carry, row, small));
}

}  // namespace

Expression sum_of_row(RoutineBuilder& b, Body& body, const Expression& carry, const StageRow& row,
                      const std::string& small) {
  Expression sum = carry;
  if (!row.small.is_zero()) sum = b.let(body, small, carry + row.small);
  for (const Expression& term : row.large) sum += term;
  return sum;
}

void set_stage(RoutineBuilder& b, Body& body, const Expression& bar, const Expression& z,
               const Expression& carry, const StageRow& row, const std::string& change) {
  body.push_back({Assign{bar.name(), moved(b, body, z, carry, row, change)}});
}

std::vector<Argument> LoopStage::arguments(bool with_states) const {
  std::vector<Argument> list = {parameters_argument()};
  if (has_coefficients_) list.push_back({.name = "k", .record = "Coefficients"});
  if (uses_h()) list.push_back({.name = "h"});
  if (with_states) {
    list.push_back(state_argument("z"));
    list.push_back(state_argument("carry"));
  }
  list.push_back({.name = "start", .record = "Start", .changes = true});
  return list;
}

std::vector<Place> LoopStage::given(const std::vector<Argument>& arguments) {
  std::vector<Place> list;
  for (const Argument& argument : arguments) list.push_back({argument.name});
  return list;
}

Expression LoopStage::momentum(RoutineBuilder& b) const {
  return arrays_.reduced ? b.at("start", "momentum", {affine("i")})
                         : b.at("start", "value", {affine("i", n_)});
}

Body LoopStage::from_state(RoutineBuilder& b) const {
  Body copy{{Assign{coordinate(b).name(), state(b, "z", "q")}}};
  if (!arrays_.reduced) copy.push_back({Assign{momentum(b).name(), state(b, "z", "p")}});
  return {for_each(elements(), std::move(copy))};
}

void LoopStage::add_time(RoutineBuilder& b, Body& body) const {
  if (!knows_time(mechanics_, weights_.member)) return;
  weights_.bind(b.routine());
  const auto last = affine(n_ - 1);
  Expression t = b.at("z", "q", {last});
  if (weights_.q_by_p) t = t + (b.at("carry", "q", {last}) + *weights_.q_by_p);
  body.push_back({Assign{b.at("start", "value", {last}).name(), t}});
}

void LoopStage::hold_time(RoutineBuilder& b, Body& body) const {
  if (!knows_time(mechanics_, weights_.member)) return;
  for (const int given : {n_ - 1, 2 * n_ - 1}) {
    if (given < unknowns())
      body.push_back({Assign{b.at("start", "lack", {affine(given)}).name(), 0}});
  }
}

void LoopStage::add_rounded_state(RoutineBuilder& b) const {
  if (!beside_) return;
  add_rounding(b, *beside_,
               {.each = elements(),
                .q = state(b, "z", "q"),
                .p = state(b, "z", "p"),
                .beside_q = rounded_with(b, false),
                .beside_p = rounded_with(b, true)});
}

Expression LoopStage::rounded_with(RoutineBuilder& b, bool momentum) const {
  if (!beside_) return state(b, "z", momentum ? "p" : "q");
  return b.at("start", "beside", {affine("i", momentum ? n_ : 0)});
}

Expression LoopStage::lack(RoutineBuilder& b, bool momentum) const {
  return b.at("start", "lack", {affine("i", momentum ? n_ : 0)});
}

Gradient LoopStage::slope(RoutineBuilder& b) const {
  return {b.at("start", "slope", {affine("i")}), b.at("start", "slope", {affine("i", n_)})};
}

Expression LoopStage::state(RoutineBuilder& b, const char* object, const char* field) {
  return b.at(object, field, {affine("i")});
}

Expression LoopStage::mass(RoutineBuilder& b) const {
  return b.at("k", "mass", loop_mass_index(arrays_, "i"));
}

void LoopStage::add_gradient(Body& body, const Place& q, const Place& p) const {
  const Place dq{"start", "slope"};
  const Place dp{"start", "slope", {affine(n_)}};
  if (raised()) {
    body.push_back(
        {Call{.routine = "generating_gradient", .arguments = {{"par"}, {"h"}, q, p, dq, dp}}});
    return;
  }
  if (!mechanics_.is_separable()) {
    body.push_back({Call{.routine = "gradient", .arguments = {{"par"}, q, p, dq, dp}}});
    return;
  }
  body.push_back({Call{.routine = "potential_gradient", .arguments = {{"par"}, q, dq}}});
  body.push_back({Call{.routine = "kinetic_gradient", .arguments = {{"par"}, p, dp}}});
}

void LoopStage::add_gradient_at_stage(Body& body, bool in_parts) const {
  if (arrays_.reduced) {
    const std::vector<Place> list = given(arguments(true));
    body.push_back({Call{.routine = evaluation(in_parts), .arguments = list}});
  } else {
    add_gradient(body, {"start", "value"}, {"start", "value", {affine(n_)}});
  }
}

Routine LoopStage::evaluate(bool in_parts) const {
  std::vector<std::string> remark = {
      "grad H at the stage, whose momenta follow from its coordinates, and what the equations",
      "lack there."};
  if (is_linear()) remark = {"grad H at the stage, whose momenta follow from its coordinates."};
  if (in_parts && both()) {
    remark = {
        "The same with h in two parts, of which neither is a simple fraction, for Newton's "
        "iteration."};
  }
  RoutineBuilder b(
      {.name = evaluation(in_parts), .remark = std::move(remark), .arguments = arguments(true)});
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
  // What linear equations lack is known far below rounding: see add_exact_lack.
  const auto end = [&] {
    if (!is_linear()) b.body().push_back(for_each(elements(), lacks(b, at, in_parts)));
    return b.take();
  };
  Body each;
  if (velocity_) {
    for (const auto& [symbol, place] : velocity_->places) b.routine().places[symbol] = place;
    environment_.bind_parameters(b.routine());
    const StageRow row = weights_.row_of_p(b, each, at);
    each.push_back({Let{velocity_->momentum, moved(b, each, z, carry, row, "change")}});
    velocity_->compute(each);
    const Expression& velocity_there = velocity_->evaluation.results.front();
    each.push_back({Assign{at.by_p.name(), velocity_there}, {}, {.terms = velocity_->terms}});
    // A number that is trivial needs no place to be read from.
    const Gradient there = {at.by_q, is_trivial(velocity_there) ? velocity_there : at.by_p};
    for (Instruction& instruction : lacks(b, there, in_parts))
      each.push_back(std::move(instruction));
    b.body().push_back(for_each(elements(), std::move(each)));
    return b.take();
  }
  if (!needs_drift()) {
    const StageRow row = weights_.row_of_p(b, each, at);
    set_stage(b, each, bar, z, carry, row, "change");
    b.body().push_back(for_each(elements(), std::move(each)));
    b.body().push_back(velocity);
    return end();
  }
  const Expression own = own_share(b);
  const Expression drift = b.at("k", "drift", {affine("i")});
  const StageRow first = weights_.row_of_p(b, each, {at.by_q, drift});
  set_stage(b, each, bar, z, carry, first, "change");
  each.push_back({Assign{bar.name(), bar * own}});
  b.body().push_back(for_each(elements(), std::move(each)));
  b.body().push_back(velocity);
  Body again;
  const StageRow row = weights_.row_of_p(b, again, at);
  const Expression missing =
      b.let(again, "missing", lacking(b, again, z, bar, carry, row, "p_small"));
  again.push_back({Assign{bar.name(), bar + missing * own}});
  b.body().push_back(for_each(elements(), std::move(again)));
  b.body().back().remark = {"What their rows lack there, rounded as they are."};
  b.body().push_back(velocity);
  return end();
}

Routine LoopStage::differentiate() const {
  std::vector<Argument> list = {parameters_argument()};
  if (has_coefficients_) list.push_back({.name = "k", .record = "Coefficients"});
  if (uses_h()) list.push_back({.name = "h"});
  list.push_back({.name = "at", .sizes = {unknowns()}, .decays = true});
  list.push_back({.name = "matrix", .record = "Matrix", .changes = true});
  RoutineBuilder b(
      {.name = "differentiate",
       .remark = {"The derivative of the equations' residual, q first, at a stage" +
                  std::string(knows_time(mechanics_, weights_.member) ? ", as if t were a number."
                                                                      : ".")},
       .arguments = std::move(list)});
  b.body().push_back({Clear{{"matrix"}}});
  Body one{{Put{{"matrix"}, affine("i"), affine("i"), Expression(1)}}};
  b.body().push_back(for_each(counting("i", unknowns()), std::move(one)));
  const Part part = arrays_.reduced ? Part::potential : Part::all;
  const StepWeights weights = weights_;
  const bool reduced = arrays_.reduced;
  const bool one_scale = arrays_.mass.has_value();
  const int n = n_;
  Mechanics of_matrix = mechanics_;
  of_matrix.kernels = kernels_of_matrix(mechanics_, weights_.member);
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
  return kernel_entries(environment_, of_matrix, part, b.take(), {"at"}, {"at", {}, {affine(n_)}},
                        use);
}

void LoopStage::add_stage(RoutineBuilder& b, Body& each) const {
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

Body LoopStage::lacks(RoutineBuilder& b, const Gradient& at, bool in_parts) const {
  Body each;
  for (const bool is_p : {false, true}) {
    if (is_p && arrays_.reduced) break;
    const char* field = is_p ? "p" : "q";
    const Expression z = state(b, "z", field);
    const Expression bar = is_p ? momentum(b) : coordinate(b);
    const StageRow row = is_p       ? weights_.row_of_p(b, each, at)
                         : in_parts ? weights_.row_of_q_in_parts(b, each, at)
                                    : weights_.row_of_q(b, each, at);
    const Expression missing =
        lacking(b, each, z, bar, state(b, "carry", field), row, is_p ? "p_small" : "q_small");
    each.push_back({Assign{lack(b, is_p).name(), missing}});
  }
  return each;
}

}  // namespace hamgen
