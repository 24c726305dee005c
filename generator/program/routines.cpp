#include "generator/program/routines.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/program/function_routines.hpp"
#include "generator/program/solve_routine.hpp"

namespace hamgen {

namespace {

// The coefficients of the program are the fields c1, c2, ... of k.
CoefficientPlaces coefficient_places(const Program& program) {
  CoefficientPlaces places;
  for (const Statement& s : program.coefficients) {
    places[s.name] = {.object = "k", .field = fmt::format("c{}", places.size() + 1)};
  }
  return places;
}

SolveParts solve_parts(const Program& program) {
  SolveParts parts{.coefficients = !program.coefficients.empty()};
  for (const Stage& stage : program.stages) {
    if (!stage.solve) continue;
    const Solve& solve = *stage.solve;
    if (solve.constant_matrix && solve.linear_solver != LinearSolver::written_out) {
      parts.coefficients = parts.inverse = true;
    }
    if (solve.kind != BlockKind::linear && !solve.sweeps) parts.start = true;
  }
  return parts;
}

// dV/dq or dT/dp of a splitting, with what it takes of k.
Routine half_gradient(const Environment& environment, const Program& program,
                      const std::string& name, const Evaluation& evaluation) {
  Routine routine = values_routine(environment, name, evaluation, StateForm::record, true);
  routine.arguments.insert(routine.arguments.begin() + 1, {.name = "k", .record = "Coefficients"});
  routine.places.merge(coefficient_places(program));
  return routine;
}

Routine modified_energies(const Environment& environment, const Program& program) {
  Routine routine = values_routine(environment, "modified_energies", program.modified_energies);
  routine.arguments.insert(routine.arguments.begin() + 1, {.name = "h"});
  const std::vector<int>& powers = program.modified_powers;
  std::string list;
  for (const int power : powers) list += fmt::format("{}h^{}", list.empty() ? "" : ", ", power);
  routine.remark = {
      fmt::format("The modified Hamiltonian H + h^{} (...) + ..., which steps of size "
                  "h conserve as a formal",
                  powers.front()),
      fmt::format("series, cut off after {}.", list)};
  return routine;
}

}  // namespace

std::vector<Routine> routines_of(const Program& program) {
  const Mechanics& mechanics = program.plan.equations.mechanics;
  const Method& method = program.plan.equations.scheme.method;
  const bool arrays = program.plan.arrays.has_value();
  const Environment environment = environment_of(program.plan.equations, arrays);
  std::vector<Routine> routines;
  const auto add = [&](Routine routine, std::string remark) {
    if (!remark.empty()) routine.remark = {std::move(remark)};
    routines.push_back(std::move(routine));
  };
  if (!mechanics.invariants.empty()) {
    std::string list;
    for (const NamedExpression& i : mechanics.invariants)
      list += (list.empty() ? "" : ", ") + i.name;
    add(values_routine(environment, "invariants", program.invariants),
        "The model's invariants: " + list + ".");
  }
  if (arrays) return routines;
  add(number_routine(environment, "energy", program.energy),
      mechanics.has_time ? "H(q, p, t) + p_t, which is constant where H(q, p, t) is not."
                         : "H(q, p).");
  if (!program.modified_powers.empty()) add(modified_energies(environment, program), "");
  add(values_routine(environment, "gradient", program.gradient),
      "grad H, the derivatives by q first.");
  const bool runge_kutta = std::holds_alternative<RungeKutta>(method);
  if (runge_kutta) {
    add(values_routine(environment, "vector_field", program.vector_field, StateForm::array),
        "J grad H at a state (q, p).");
  }
  if (!program.hessian_places.empty()) {
    add(hessian_routine(environment, program.hessian, program.hessian_places,
                        runge_kutta ? StateForm::array : StateForm::record),
        "The second derivatives of H at z.");
  }
  if (std::holds_alternative<Splitting>(method)) {
    add(half_gradient(environment, program, "potential_gradient", program.potential_gradient),
        "dV/dq at z.");
    add(half_gradient(environment, program, "kinetic_gradient", program.kinetic_gradient),
        "dT/dp at z.");
  }
  if (program.plan.equations.scheme.has_member()) {
    routines.push_back(
        solve_routine(environment, program, solve_parts(program), coefficient_places(program)));
  }
  return routines;
}

const Routine* find_routine(const std::vector<Routine>& routines, std::string_view name) {
  const auto it = std::ranges::find(routines, name, &Routine::name);
  return it == routines.end() ? nullptr : &*it;
}

}  // namespace hamgen
