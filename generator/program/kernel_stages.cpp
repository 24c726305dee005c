// Functions of a system in loops at all stages of an implicit Runge-Kutta method.
#include <algorithm>

#include "generator/program/kernel_routines.hpp"
#include "generator/program/routine_builder.hpp"

namespace hamgen {

namespace {

bool has_loop_over(const Body& body, const std::string& index) {
  return std::ranges::any_of(body, [&](const Instruction& instruction) {
    const auto* loop = std::get_if<For>(&instruction.value);
    if (loop != nullptr && loop->range.index == index) return true;
    return std::ranges::any_of(inner_bodies(instruction),
                               [&](const Body* inner) { return has_loop_over(*inner, index); });
  });
}

Argument stage_array(const char* name, const StageLayout& layout, bool changes) {
  return {.name = name, .sizes = {layout.count()}, .changes = changes};
}

// values of the momenta = -values
Instruction turn(RoutineBuilder& b, const StageLayout& layout) {
  const int n = layout.dimension / 2;
  const Expression value = b.at("values", "", {layout.index("i", 0, "j", n)});
  Body each{{Assign{value.name(), -value}}};
  Body all;
  all.push_back(for_each(counting("j", n), std::move(each)));
  return in_lanes(counting("i", layout.room()), layout.packs(), std::move(all));
}

}  // namespace

Routine at_stages(Routine routine, const StageLayout& layout) {
  std::string stage = "i";
  while (has_loop_over(routine.body, stage)) stage = stage == "i" ? "stage" : stage + "_";
  std::set<std::string> arrays;
  for (Argument& argument : routine.arguments) {
    if (argument.sizes.empty()) continue;
    arrays.insert(argument.name);
    argument.sizes = {argument.sizes.front() * layout.room()};
  }
  for (auto& [symbol, place] : routine.places) {
    if (!arrays.contains(place.object)) continue;
    AffineIndex& index = place.indices.at(0);
    index.constant *= layout.room();
    for (auto& [name, factor] : index.factors) factor *= layout.room();
    index.factors[stage] = 1;
  }
  routine.name += "s";
  Body body;
  body.push_back(in_lanes(counting(stage, layout.room()), layout.packs(), std::move(routine.body)));
  routine.body = std::move(body);
  return routine;
}

Routine array_vector_fields(const StageLayout& layout, bool separable) {
  RoutineBuilder b({.name = "vector_fields",
                    .remark = {"J grad H at all stages."},
                    .arguments = {parameters_argument(), stage_array("z", layout, false),
                                  stage_array("values", layout, true)}});
  const AffineIndex half = affine(static_cast<long>(layout.room()) * layout.dimension / 2);
  const Place first{"z"};
  const Place second{"z", "", {half}};
  const Place slopes{"values"};
  const Place forces{"values", "", {half}};
  if (separable) {
    b.body().push_back(
        {Call{.routine = "potential_gradients", .arguments = {{"par"}, first, forces}}});
    b.body().push_back(
        {Call{.routine = "kinetic_gradients", .arguments = {{"par"}, second, slopes}}});
  } else {
    b.body().push_back(
        {Call{.routine = "gradients", .arguments = {{"par"}, first, second, forces, slopes}}});
  }
  b.body().push_back(turn(b, layout));
  return b.take();
}

Routine array_forces(const StageLayout& layout) {
  RoutineBuilder b({.name = "forces",
                    .remark = {"-dH/dq at all stages."},
                    .arguments = {parameters_argument(), stage_array("z", layout, false),
                                  stage_array("values", layout, true)}});
  const AffineIndex half = affine(static_cast<long>(layout.room()) * layout.dimension / 2);
  b.body().push_back({Call{.routine = "potential_gradients",
                           .arguments = {{"par"}, {"z"}, {"values", "", {half}}}}});
  b.body().push_back(turn(b, layout));
  return b.take();
}

}  // namespace hamgen
