// Functions of the state of a system in loops that are made of others.
#include "generator/program/kernel_routines.hpp"

namespace hamgen {

Routine both_gradients(const Environment& environment) {
  const int n = environment.degrees_of_freedom;
  Routine routine{.name = "gradient", .remark = {"dq[i] = dH/dq_i, dp[i] = dH/dp_i."}};
  routine.arguments = {parameters_argument()};
  for (const char* name : {"q", "p", "dq", "dp"}) {
    routine.arguments.push_back(
        {.name = name, .sizes = {n}, .changes = name[0] == 'd', .decays = true});
  }
  routine.body.push_back(
      {Call{.routine = "potential_gradient", .arguments = {{"par"}, {"q"}, {"dq"}}}});
  routine.body.push_back(
      {Call{.routine = "kinetic_gradient", .arguments = {{"par"}, {"p"}, {"dp"}}}});
  return routine;
}

Routine array_vector_field(const Environment& environment) {
  const int n = environment.degrees_of_freedom;
  Routine routine{.name = "vector_field",
                  .remark = {"J grad H at a state (q, p)."},
                  .arguments = {parameters_argument(),
                                {.name = "x", .sizes = {2 * n}, .decays = true},
                                {.name = "f", .sizes = {2 * n}, .changes = true, .decays = true}}};
  const Place second_x{.object = "x", .indices = {{n, {}}}};
  const Place second_f{.object = "f", .indices = {{n, {}}}};
  routine.body.push_back(
      {Call{.routine = "gradient", .arguments = {{"par"}, {"x"}, second_x, second_f, {"f"}}}});
  routine.places["f(n+i)"] = {.object = "f", .indices = {{n, {{"i", 1}}}}};
  Body turn{{Assign{"f(n+i)", -Expression::symbol("f(n+i)")}}};
  routine.body.push_back({For{{"i", {0, {}}, {n - 1, {}}}, std::move(turn)}});
  return routine;
}

Routine array_hessian(const Environment& environment, const Mechanics& mechanics) {
  const int n = environment.degrees_of_freedom;
  Routine begun{.name = "hessian",
                .remark = {"The second derivatives of H at a state (q, p), added to values."},
                .arguments = {parameters_argument(),
                              {.name = "x", .sizes = {2 * n}, .decays = true},
                              {.name = "values", .sizes = {2 * n, 2 * n}, .changes = true}}};
  const auto use = [n](Routine& routine, Body& body, const HessianEntry& entry) {
    Place place{.object = "values"};
    for (const StateElement* element : {&entry.row, &entry.column}) {
      place.indices.push_back(element->index);
      if (element->is_momentum) place.indices.back().constant += n;
    }
    routine.places.insert_or_assign(to_text(place), place);
    body.push_back({Accumulate{to_text(place), entry.value}});
  };
  return kernel_entries(environment, mechanics, Part::all, std::move(begun), {"x"},
                        {"x", {}, {{n, {}}}}, use);
}

}  // namespace hamgen
