#include "generator/program/stage_coordinates.hpp"

#include <algorithm>

namespace hamgen {

Field StageCoordinates::base() const {
  return {.name = "base", .sizes = {coordinates()}, .remark = "q + h c_i dH/dp(p)"};
}

Expression StageCoordinates::moved(RoutineBuilder& b, const Expression& momentum) const {
  if (order_.unit_mobility) return momentum;
  const Expression mobility = b.at("k", "mobility", {affine("j")});
  return mobility * momentum;
}

std::vector<Routine> StageCoordinates::routines() const {
  return {begin(), evaluate(), end(), eliminate(), end_refinement()};
}

Routine StageCoordinates::begin() const {
  RoutineBuilder b({.name = "begin_coordinates",
                    .remark = {"Where the coordinates of the stages were without forces."},
                    .arguments = with_start(false)});
  Body each;
  const Expression from = state(b);
  if (environment_.arrays) {
    const AffineIndex momenta = affine(static_cast<long>(layout_.room()) * n_);
    b.body().push_back(
        {Call{.routine = "kinetic_gradients",
              .arguments = {{"par"}, {"start", "state", {momenta}}, {"start", "base"}}}});
    const Expression node = b.at("k", "node", {affine("i")});
    const Expression base = of_start(b, "base", row());
    each.push_back({Assign{base.name(), from + node * base}});
    b.body().push_back(for_all(std::move(each), n_));
    return b.take();
  }
  environment_.bind_parameters(b.routine());
  std::set<std::string> used = used_symbols(order_.velocities.statements);
  for (const Expression& e : order_.velocities.results) collect_symbols(e, used);
  for (int c = 0; c < dimension_; ++c) {
    const std::string& variable = environment_.variables[static_cast<std::size_t>(c)].name;
    if (used.contains(variable))
      b.body().push_back({Let{variable, of_start(b, "state", affine(layout_.at(0, c)))}});
  }
  append(b.body(), order_.velocities.statements);
  b.body().push_back({Array{"velocity", {n_}, order_.velocities.results}});
  const Expression way = b.product({"k", "node", {affine("i")}}, {"velocity", "", {affine("j")}});
  each.push_back({Assign{of_start(b, "base", row()).name(), from + way}});
  b.body().push_back(for_all(std::move(each), n_));
  return b.take();
}

Routine StageCoordinates::evaluate() const {
  RoutineBuilder b({.name = "evaluate_coordinates",
                    .remark = {"L_i of the momenta, and what the coordinates lack once the momenta "
                               "are eliminated."},
                    .arguments = with_start(false)});
  b.body().push_back(
      {Call{.routine = "forces", .arguments = {{"par"}, {"start", "value"}, {"start", "slope"}}}});
  const Expression slope = of_start(b, "slope", row(n_));
  const Expression scaled = b.at("k", "scaled", {affine("i")});
  Body scale{{Assign{slope.name(), scaled * slope}}};
  b.body().push_back(for_all(std::move(scale), n_));
  Body each;
  const Expression pushed = b.let(each, "pushed", combination(b, "twice", n_));
  const Expression base = of_start(b, "base", row());
  const Expression value = of_start(b, "value", row());
  each.push_back({Assign{of_start(b, "lack", row()).name(), base - value + moved(b, pushed)}});
  b.body().push_back(for_all(std::move(each), n_));
  return b.take();
}

Routine StageCoordinates::end() const {
  RoutineBuilder b({.name = "end_coordinates",
                    .remark = {"The momenta of the stages."},
                    .arguments = with_start(false)});
  Body each;
  const Expression from = state(b, n_);
  const Expression sum = b.let(each, "moved", combination(b, "coupling", n_));
  const Expression small = of_start(b, "small", affine("j", n_));
  each.push_back({Assign{of_start(b, "value", row(n_)).name(), from + sum + small}});
  b.body().push_back(for_all(std::move(each), n_));
  return b.take();
}

Routine StageCoordinates::eliminate() const {
  RoutineBuilder b({.name = "eliminate_momenta",
                    .remark = {"What the coordinates lack once the momenta have what they lack."},
                    .arguments = with_start(false)});
  Body each;
  Expression sum(0);
  for (int m = 0; m < stages_; ++m) {
    const Expression coupling = entry(b, "coupling", affine(m));
    const Expression scaled = b.at("k", "scaled", {affine(m)});
    sum += coupling * (scaled * of_start(b, "lack", row_of(m, n_)));
  }
  const Expression pushed = b.let(each, "pushed", sum);
  const Expression lack = of_start(b, "lack", row());
  each.push_back({Assign{lack.name(), lack + moved(b, pushed)}});
  b.body().push_back(for_all(std::move(each), n_));
  return b.take();
}

// The forces change by what is refined, the momenta by what they lacked and by that.
Routine StageCoordinates::end_refinement() const {
  RoutineBuilder b({.name = "end_refinement",
                    .remark = {"What L_i of the coordinates lack, once those of the momenta have "
                               "what they lack."},
                    .arguments = with_start(false)});
  Body each;
  Expression sum = of_start(b, "lack", row(n_));
  for (int m = 0; m < stages_; ++m) {
    const Expression coupling = entry(b, "coupling", affine(m));
    sum += coupling * of_start(b, "refinement.change", row_of(m, n_));
  }
  const Expression lack = b.let(each, "pushed", sum);
  const Expression scaled = b.at("k", "scaled", {affine("i")});
  each.push_back({Assign{of_start(b, "refinement.change", row()).name(), scaled * moved(b, lack)}});
  b.body().push_back(for_all(std::move(each), n_));
  return b.take();
}

}  // namespace hamgen
