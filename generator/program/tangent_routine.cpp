#include "generator/program/tangent_routine.hpp"

#include <fmt/format.h>

#include "generator/program/coefficients.hpp"
#include "generator/program/routine_builder.hpp"

namespace hamgen {

namespace {

std::string numbered(const char* stem, std::size_t s) { return fmt::format("{}_{}", stem, s); }

}  // namespace

Routine tangent_routine(const Environment& environment, std::string name,
                        const Linearisation& linearisation, bool large) {
  const int size = 2 * environment.degrees_of_freedom;
  Routine routine{
      .name = std::move(name),
      .remark =
          {"M = dZ/dz of the step that moves z by dz, solved as the step is: a displacement u",
           "moves the stage by dzbar = u + h (I/2 + C) J H'' dzbar, and Z by u + h J H'' "
           "dzbar.",
           "False if that has no solution."},
      .result = {.type = "bool"},
      .arguments = {parameters_argument(),
                    {.name = "h"},
                    state_argument("z"),
                    state_argument("dz"),
                    {.name = "m", .sizes = {size, size}, .changes = true}}};
  environment.bind_parameters(routine);
  const auto bind = [&](const std::string& symbol, Place place) {
    routine.places.insert_or_assign(symbol, std::move(place));
    return symbol;
  };
  for (int i = 0; i < size; ++i) {
    const std::string& variable = environment.variables.name(static_cast<std::size_t>(i));
    bind("dz(" + variable + ")", environment.place("dz", i));
    bind("u(" + variable + ")", {"u", "", {{i, {}}}});
  }
  environment.load_state(routine, routine.body, used_symbols(linearisation.once));
  append(routine.body, linearisation.once);
  for (std::size_t s = 0; s < linearisation.stages.size(); ++s) {
    const auto& solve = linearisation.stages[s].solve;
    if (!solve) continue;
    put_matrix(routine.body, numbered("matrix", s), solve->matrix,
               large ? MatrixForm::large : MatrixForm::plain);
    routine.body.push_back({Factorise{{numbered("matrix", s)}}});
  }
  const AffineIndex column{0, {{"column", 1}}};
  Body each;
  each.push_back({Array{"u", {size}}});
  each.push_back({Assign{bind("u of column", {"u", "", {column}}), Expression(1)}});
  for (std::size_t s = 0; s < linearisation.stages.size(); ++s) {
    const Linearisation::Stage& stage = linearisation.stages[s];
    append(each, stage.before);
    if (!stage.solve) continue;
    const LinearisedSolve& solve = *stage.solve;
    const std::string vector = numbered("vector", s);
    each.push_back({Array{vector, {static_cast<int>(solve.solution.size())}, solve.right_side}});
    each.push_back({SolveFactorised{{numbered("matrix", s)}, {vector}}});
    for (std::size_t j = 0; j < solve.solution.size(); ++j) {
      each.push_back(
          {Let{solve.solution[j], bind_element(routine, vector, {static_cast<int>(j)})}});
    }
  }
  for (int i = 0; i < size; ++i) {
    const std::string entry = bind(fmt::format("m({},column)", i), {"m", "", {{i, {}}, column}});
    each.push_back({Assign{entry, linearisation.results[static_cast<std::size_t>(i)]}});
  }
  const AffineIndex last{size - 1, {}};
  routine.body.push_back(for_each(counting("column", size), std::move(each)));
  const std::string entry = bind("m(i,j)", {"m", "", {{0, {{"i", 1}}}, {0, {{"j", 1}}}}});
  routine.body.push_back(
      {Return{.finite = {entry}, .ranges = {{"i", {0, {}}, last}, {"j", {0, {}}, last}}}});
  return routine;
}

}  // namespace hamgen
