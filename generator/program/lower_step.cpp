#include <algorithm>

#include "generator/program/linear_terms.hpp"
#include "generator/program/lower.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/program/step_builder.hpp"
#include "generator/solvers/array_matrix.hpp"

namespace hamgen {

Evaluation evaluate_together(const std::vector<Expression>& values) {
  Lowering lowering({Section{}});
  std::set<std::string> free;
  for (const Expression& value : values) collect_symbols(value, free);
  for (const std::string& symbol : free) lowering.declare(symbol, 0);
  std::vector<std::size_t> handles;
  for (const Expression& value : values) handles.push_back(lowering.want(value, 0));
  lowering.run();
  Evaluation evaluation{.statements = lowering.statements(0)};
  for (const std::size_t handle : handles) evaluation.results.push_back(lowering.wanted(handle));
  return evaluation;
}

namespace {

// dV/dq and dT/dp share no variable, so one pass lowers both; what depends on parameters alone is
// computed once per run.
void build_splitting(LoweredStep& lowered, const Mechanics& mechanics) {
  Lowering lowering({Section{}, Section{}, Section{}});
  const int n = mechanics.degrees_of_freedom;
  for (const Quantity& parameter : mechanics.parameters) lowering.declare(parameter.name, 0);
  std::vector<std::size_t> handles;
  for (int i = 0; i < 2 * n; ++i) {
    lowering.declare(mechanics.variable(i).name(), i < n ? 1 : 2);
    handles.push_back(
        lowering.want(mechanics.gradient[static_cast<std::size_t>(i)], i < n ? 1 : 2));
  }
  lowering.run();
  lowered.coefficients = lowering.statements(0);
  lowered.potential_gradient.statements = lowering.statements(1);
  lowered.kinetic_gradient.statements = lowering.statements(2);
  for (int i = 0; i < 2 * n; ++i) {
    (i < n ? lowered.potential_gradient : lowered.kinetic_gradient)
        .results.push_back(lowering.wanted(handles[static_cast<std::size_t>(i)]));
  }
}

// grad H, its linear terms with constants in two parts: see Note [constants in two parts] in
// step_builder.hpp.
Evaluation evaluate_in_parts(const Mechanics& mechanics) {
  Lowering lowering({Section{}});
  for (const Quantity& parameter : mechanics.parameters) lowering.declare(parameter.name, 0);
  std::set<std::string> state;
  for (int i = 0; i < 2 * mechanics.degrees_of_freedom; ++i) {
    state.insert(mechanics.variable(i).name());
    lowering.declare(mechanics.variable(i).name(), 0);
  }
  std::set<std::string> named;
  const auto define = [&](const std::string& name, const Expression& value, bool apart = false) {
    const Lowering::Keep keep = apart ? Lowering::Keep::apart : Lowering::Keep::no;
    if (named.insert(name).second) lowering.define(name, value, 0, keep);
    return Expression::symbol(name, kRankOfTemporary);
  };
  int sums = 0;
  const LinearTerms terms(std::move(state));
  const LinearTerms::Definitions definitions{
      .in_two_parts = [&](const Expression& c) { return in_two_parts(c, define); },
      .at_stage = [](const Expression& sum) { return sum; },
      .of_small_parts =
          [&](const Expression& sum) { return define("rest " + std::to_string(++sums), sum); }};
  std::vector<std::size_t> handles;
  for (const Expression& value : mechanics.gradient)
    handles.push_back(lowering.want(terms.split(value, definitions), 0));
  lowering.run();
  Evaluation evaluation{.statements = lowering.statements(0)};
  for (const std::size_t handle : handles) evaluation.results.push_back(lowering.wanted(handle));
  return evaluation;
}

// J grad H from grad H = (H_q, H_p).
Evaluation rotated(const Evaluation& gradient) {
  Evaluation field{.statements = gradient.statements};
  const auto middle = gradient.results.begin() + std::ssize(gradient.results) / 2;
  field.results.assign(middle, gradient.results.end());
  for (auto it = gradient.results.begin(); it != middle; ++it) field.results.push_back(-*it);
  return field;
}

void build_hessian(LoweredStep& lowered, const Mechanics& mechanics) {
  std::vector<Expression> values;
  for (const auto& [place, value] : mechanics.hessian) {
    lowered.hessian_places.push_back(place);
    values.push_back(value);
  }
  lowered.hessian = evaluate_together(values);
}

}  // namespace

LoweredStep with_tangent(LoweredStep lowered) {
  lowered.tangent = true;
  const StepEquations& equations = lowered.plan.equations;
  const bool solved = equations.scheme.has_member() && !lowered.plan.sweeps;
  if (lowered.plan.arrays) {
    // Of a fixed point, too, the linearised equations are solved by elimination; systems that are
    // too large for that have no tangent map.
    ArrayPlan& arrays = *lowered.plan.arrays;
    if (iterates(arrays) && !arrays.matrix) {
      const FamilyParameters member = uniform_parameters(equations.scheme.member()).value();
      arrays.matrix = choose_matrix(equations.mechanics, member, arrays.reduced, arrays.eigen);
    }
  } else if (solved) {
    lowered.linearisation = linearise(lowered.plan);
  } else if (lowered.hessian_places.empty()) {
    build_hessian(lowered, equations.mechanics);
  }
  return lowered;
}

namespace {

LoweredStep lowered_step(const SolvePlan& plan) {
  const Mechanics& mechanics = plan.equations.mechanics;
  LoweredStep lowered{.plan = plan};
  if (!plan.arrays) {
    if (plan.equations.scheme.has_member()) lowered = StepBuilder(plan).build();
    if (std::holds_alternative<Splitting>(plan.equations.scheme.method)) {
      build_splitting(lowered, mechanics);
    }
    if (plan.stage_solver) build_hessian(lowered, mechanics);
    lowered.energy = evaluate_together({mechanics.energy});
    lowered.gradient = evaluate_together(plan.equations.function ? plan.equations.energy_gradient
                                                                 : mechanics.gradient);
    if (std::holds_alternative<RungeKutta>(plan.equations.scheme.method)) {
      lowered.vector_field =
          rotated(plan.stage_solver && has_linear_forces(mechanics) ? evaluate_in_parts(mechanics)
                                                                    : lowered.gradient);
    }
  }
  lowered.sequence = sequence_of(plan.equations.scheme);
  std::vector<Expression> invariants;
  std::vector<Expression> events;
  for (const NamedExpression& each : mechanics.invariants)
    (each.is_event() ? events : invariants).push_back(each.value);
  lowered.invariants = evaluate_together(invariants);
  lowered.events = evaluate_together(events);
  return lowered;
}

// Ht, cut off after each of its terms, as functions of h and the state.
void add_modified_energies(LoweredStep& lowered, const std::vector<Expression>& terms) {
  const Expression h = step_size();
  std::vector<Expression> sums;
  Expression sum;
  Expression power(1);
  for (std::size_t j = 0; j < terms.size(); ++j) {
    sum += power * terms[j];
    power = power * h;
    if (j == 0 || terms[j].is_zero()) continue;
    sums.push_back(sum);
    lowered.modified_powers.push_back(static_cast<int>(j));
  }
  lowered.modified_energies = evaluate_together(sums);
}

}  // namespace

std::optional<SecondOrder> second_order_of(const Mechanics& mechanics) {
  if (!mechanics.is_separable()) return {};
  const int n = mechanics.degrees_of_freedom;
  if (mechanics.keeps_sums()) {
    if (!has_diagonal_kinetic_energy(mechanics)) return {};
    return SecondOrder{.unit_mobility = uniform_mass(mechanics) == Expression(1)};
  }
  // abs(p)'' is 0 too, and its velocity jumps.
  const std::set<std::string> beyond = non_polynomial_symbols(mechanics.energy);
  for (int i = n; i < 2 * n; ++i) {
    if (beyond.contains(mechanics.variable(i).name())) return {};
  }
  SecondOrder result;
  std::set<std::string> state;
  for (int i = 0; i < 2 * n; ++i) state.insert(mechanics.variable(i).name());
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (!mechanics.second_derivative(n + i, n + j).is_zero()) return {};
    }
    result.mobility.push_back(mechanics.second_derivative(n + i, n + i));
    for (const std::string& name : symbols(result.mobility.back())) {
      if (state.contains(name)) return {};
    }
  }
  result.unit_mobility = std::ranges::all_of(
      result.mobility, [](const Expression& each) { return each == Expression(1); });
  const auto middle = mechanics.gradient.begin() + n;
  std::vector<Expression> forces;
  for (auto it = mechanics.gradient.begin(); it != middle; ++it) forces.push_back(-*it);
  result.forces = evaluate_together(forces);
  result.velocities = evaluate_together({middle, mechanics.gradient.end()});
  return result;
}

LoweredStep lower_step(const SolvePlan& plan, const StepWishes& wishes) {
  LoweredStep lowered = lowered_step(plan);
  lowered.unchecked = wishes.unchecked;
  lowered.plain_sums = wishes.plain_sums;
  // Lanes are trajectories that wait together: their functions are under way side by side.
  if (wishes.trajectories_in_lanes) lowered.plan.ahead = false;
  if (plan.stage_solver) {
    const auto stages = static_cast<int>(lowered.sequence.stages.weight.size());
    const int dimension = 2 * plan.equations.mechanics.degrees_of_freedom;
    StageLayout layout{.stages = stages, .dimension = dimension};
    if (!plan.arrays || wishes.trajectories_in_lanes) layout.lanes = 1;
    if (wishes.stages_in_lanes) layout = stages_in_lanes(stages, dimension);
    lowered.stage_layout = layout;
    if (layout.by_component() && *plan.stage_solver != StageSolver::newton)
      lowered.second_order = second_order_of(plan.equations.mechanics);
  }
  if (wishes.tangent) lowered = with_tangent(std::move(lowered));
  if (!wishes.modified_terms.empty()) add_modified_energies(lowered, wishes.modified_terms);
  return lowered;
}

}  // namespace hamgen
