#include "generator/program/tangent_products.hpp"

#include "generator/program/environment.hpp"
#include "generator/program/kernel_routines.hpp"

namespace hamgen {

TangentBuilder::TangentBuilder(const Environment& environment, const LoweredStep& lowered,
                               std::string name, std::vector<std::string> remark)
    : RoutineBuilder({.name = std::move(name), .remark = std::move(remark)}),
      environment_(environment),
      n_(environment.degrees_of_freedom),
      arrays_(lowered.plan.arrays.has_value()),
      raised_(lowered.plan.equations.function.has_value()) {
  routine().result = {.type = "bool"};
  routine().arguments = {parameters_argument(),
                         {.name = "h"},
                         state_argument("z"),
                         state_argument("dz"),
                         {.name = "m", .sizes = {2 * n_, 2 * n_}, .changes = true}};
  environment.bind_parameters(routine());
}

std::pair<Place, Place> TangentBuilder::halves(const TangentPoint& point) const {
  if (point.is_record) return {{point.place.object, "q"}, {point.place.object, "p"}};
  Place second = point.place;
  if (second.indices.empty()) second.indices = {{}};
  second.indices.front().constant += n_;
  return {point.place, second};
}

void TangentBuilder::add_gradient(Body& body, const TangentPoint& point,
                                  const std::string& values) const {
  if (!arrays_) {
    body.push_back({Call{.routine = "gradient", .arguments = {{"par"}, point.place, {values}}}});
    return;
  }
  const auto [q, p] = halves(point);
  const Place dp{values, "", {affine(n_)}};
  if (raised_) {
    body.push_back({Call{.routine = "generating_gradient",
                         .arguments = {{"par"}, {"h"}, q, p, {values}, dp}}});
    return;
  }
  body.push_back({Call{.routine = "gradient", .arguments = {{"par"}, q, p, {values}, dp}}});
}

Instruction TangentBuilder::curvature(const Place& q, const Place& p, const Place& u) const {
  if (raised_) return tangent_call("curvature", {{"par"}, {"h"}, q, p, u, {"y"}});
  return tangent_call("curvature", {{"par"}, q, p, u, {"y"}});
}

void TangentBuilder::for_components(
    Body& body, const std::function<void(Body&, const Component&, const AffineIndex&)>& each) {
  if (!arrays_) {
    for (int i = 0; i < 2 * n_; ++i) {
      each(
          body, [&](const std::string& record) { return at(environment_.place(record, i)); },
          affine(i));
    }
    return;
  }
  Body loop;
  for (const char* field : {"q", "p"}) {
    each(
        loop, [&](const std::string& record) { return at(record, field, {affine("row")}); },
        affine("row", field[0] == 'q' ? 0 : n_));
  }
  body.push_back(for_each(counting("row", n_), std::move(loop)));
}

void TangentBuilder::add_increment(Body& body, const std::string& state,
                                   const std::string& increment) {
  for_components(body, [&](Body& to, const Component& of, const AffineIndex&) {
    to.push_back({Accumulate{of(state).name(), of(increment)}});
  });
}

Instruction TangentBuilder::for_rows(int count, Body each) const {
  Body columns;
  columns.push_back(for_each(counting("column", 2 * n_), std::move(each)));
  return for_each(counting("row", count), std::move(columns));
}

Instruction TangentBuilder::for_entries(Body each) const {
  return for_rows(2 * n_, std::move(each));
}

Expression TangentBuilder::entry(const std::string& matrix, long first) {
  return at(matrix, "", {affine("row", first), affine("column")});
}

Instruction TangentBuilder::set_unit(const std::string& matrix) {
  Body row;
  Body zero{{Assign{entry(matrix).name(), Expression(0)}}};
  row.push_back(for_each(counting("column", 2 * n_), std::move(zero)));
  row.push_back({Assign{at(matrix, "", {affine("row"), affine("row")}).name(), Expression(1)}});
  return for_each(counting("row", 2 * n_), std::move(row));
}

void TangentBuilder::multiply_hessian(Body& body, const TangentPoint& point, const std::string& in,
                                      const std::string& out) {
  if (arrays_) {
    const auto [q, p] = halves(point);
    Body column;
    column.push_back({Array{"u", {2 * n_}}});
    column.push_back({Array{"y", {2 * n_}}});
    Body read{{Assign{at("u", "", {affine("row")}).name(), entry(in)}}};
    column.push_back(for_each(counting("row", 2 * n_), std::move(read)));
    column.push_back(curvature(q, p, {"u"}));
    Body write{{Assign{entry(out).name(), at("y", "", {affine("row")})}}};
    column.push_back(for_each(counting("row", 2 * n_), std::move(write)));
    body.push_back(for_each(counting("column", 2 * n_), std::move(column)));
    return;
  }
  Body scope;
  scope.push_back({Array{"values", {2 * n_, 2 * n_}}});
  scope.push_back({Call{.routine = "hessian", .arguments = {{"par"}, point.place, {"values"}}}});
  Body each{{Assign{entry(out).name(), Expression(0)}}};
  Body term{{Accumulate{entry(out).name(), product({"values", "", {affine("row"), affine("l")}},
                                                   {in, "", {affine("l"), affine("column")}})}}};
  each.push_back(for_each(counting("l", 2 * n_), std::move(term)));
  scope.push_back(for_entries(std::move(each)));
  body.push_back({Scope{std::move(scope)}});
}

void TangentBuilder::finish() {
  body().push_back({Return{.finite = {entry("m").name()},
                           .ranges = {counting("row", 2 * n_), counting("column", 2 * n_)}}});
}

Instruction tangent_call(std::string routine, std::vector<Place> arguments) {
  return {Call{.routine = std::move(routine), .arguments = std::move(arguments)}};
}

Instruction prepared(Place h) {
  return {Call{.routine = "prepare",
               .arguments = {{"par"}, std::move(h)},
               .record = "Coefficients",
               .object = "k"}};
}

void add_step(Body& body, const Program& code, const std::string& h, const std::string& state) {
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

std::string curvature_name(Part part) {
  return part == Part::potential ? "potential_curvature" : "curvature";
}

Routine curvature_routine(const Environment& environment, const StepEquations& equations,
                          Part part) {
  const int n = environment.degrees_of_freedom;
  const bool all = part == Part::all;
  const int size = all ? 2 * n : n;
  RoutineBuilder b({.name = curvature_name(part),
                    .remark = {!all                 ? "y = V'' u at a stage."
                               : equations.function ? "y = K'' u at a state, q first."
                                                    : "y = H'' u at a state, q first."},
                    .arguments = {parameters_argument()}});
  std::vector<Argument>& list = b.routine().arguments;
  if (equations.function) list.push_back({.name = "h"});
  list.push_back({.name = "q", .sizes = {n}, .decays = true});
  if (all) list.push_back({.name = "p", .sizes = {n}, .decays = true});
  list.push_back({.name = "u", .sizes = {size}, .decays = true});
  list.push_back({.name = "y", .sizes = {size}, .changes = true, .decays = true});
  // A coordinate may be called y.
  Body zero{{Assign{at_apart(b.routine(), {"y", "", {affine("i")}}).name(), Expression(0)}}};
  b.body().push_back(for_each(counting("i", size), std::move(zero)));
  const auto use = [n](Routine& routine, Body& body, const HessianEntry& entry) {
    const auto element = [&](const char* array, const StateElement& of) {
      AffineIndex index = of.index;
      if (of.is_momentum) index.constant += n;
      return at_apart(routine, {array, "", {index}});
    };
    body.push_back(
        {Accumulate{element("y", entry.row).name(), entry.value * element("u", entry.column)}});
  };
  return kernel_entries(environment, equations.mechanics, part, b.take(), {"q"}, {"p"}, use);
}

}  // namespace hamgen
