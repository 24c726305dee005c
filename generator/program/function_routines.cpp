#include "generator/program/function_routines.hpp"

#include "generator/program/routine_builder.hpp"

namespace hamgen {

namespace {

// name(par, z) with the statements of the evaluation in its body.
Routine begin(const Environment& environment, std::string name, const Evaluation& evaluation,
              StateForm form) {
  Routine routine{.name = std::move(name)};
  const int size = 2 * environment.degrees_of_freedom;
  routine.arguments.push_back(parameters_argument());
  routine.arguments.push_back(form == StateForm::record
                                  ? state_argument("z")
                                  : Argument{.name = "z", .sizes = {size}, .decays = true});
  environment.bind_parameters(routine);
  std::set<std::string> used = used_symbols(evaluation.statements);
  for (const Expression& e : evaluation.results) collect_symbols(e, used);
  if (form == StateForm::record) {
    environment.load_state(routine, routine.body, used);
  } else {
    for (int i = 0; i < size; ++i) {
      const std::string& variable = environment.variables.name(static_cast<std::size_t>(i));
      if (!used.contains(variable)) continue;
      routine.body.push_back({Let{variable, bind_element(routine, "z", {i})}});
    }
  }
  append(routine.body, evaluation.statements);
  return routine;
}

void set(Routine& routine, const std::vector<int>& indices, const Expression& value) {
  const Expression target = bind_element(routine, "values", indices);
  routine.body.push_back({Assign{target.name(), value}});
}

}  // namespace

Routine number_routine(const Environment& environment, std::string name,
                       const Evaluation& evaluation) {
  Routine routine = begin(environment, std::move(name), evaluation, StateForm::record);
  routine.result = {.type = "Real"};
  routine.body.push_back({Return{.value = evaluation.results.front()}});
  return routine;
}

Routine values_routine(const Environment& environment, std::string name,
                       const Evaluation& evaluation, StateForm form, bool sparse) {
  Routine routine = begin(environment, std::move(name), evaluation, form);
  const auto size = static_cast<int>(evaluation.results.size());
  routine.arguments.push_back(
      {.name = "values", .sizes = {size}, .changes = true, .decays = form == StateForm::array});
  for (int i = 0; i < size; ++i) {
    const Expression& result = evaluation.results[static_cast<std::size_t>(i)];
    if (!sparse || !result.is_zero()) set(routine, {i}, result);
  }
  return routine;
}

Routine stage_values_routine(const Environment& environment, std::string name,
                             const Evaluation& evaluation, const StageLayout& layout, int first) {
  RoutineBuilder b({.name = std::move(name),
                    .arguments = {parameters_argument(),
                                  {.name = "z", .sizes = {layout.count()}},
                                  {.name = "values", .sizes = {layout.count()}, .changes = true}}});
  environment.bind_parameters(b.routine());
  std::set<std::string> used = used_symbols(evaluation.statements);
  for (const Expression& e : evaluation.results) collect_symbols(e, used);
  const auto place = [&](int component) { return layout.index("i", 0, "", component); };
  Body each;
  for (int c = 0; c < layout.dimension; ++c) {
    const std::string& variable = environment.variables[static_cast<std::size_t>(c)].name;
    if (used.contains(variable)) each.push_back({Let{variable, b.at("z", "", {place(c)})}});
  }
  append(each, evaluation.statements);
  for (const Expression& result : evaluation.results)
    each.push_back({Assign{b.at("values", "", {place(first++)}).name(), result}});
  b.body().push_back(in_lanes(counting("i", layout.room()), layout.packs(), std::move(each)));
  return b.take();
}

Routine hessian_routine(const Environment& environment, const Evaluation& entries,
                        const std::vector<std::pair<int, int>>& places, StateForm form) {
  Routine routine = begin(environment, "hessian", entries, form);
  const int size = 2 * environment.degrees_of_freedom;
  routine.arguments.push_back({.name = "values", .sizes = {size, size}, .changes = true});
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto [i, j] = places[k];
    set(routine, {i, j}, entries.results[k]);
    if (i != j) set(routine, {j, i}, bind_element(routine, "values", {i, j}));
  }
  return routine;
}

}  // namespace hamgen
