#include "generator/program/lower.hpp"
#include "generator/program/program.hpp"
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
void build_splitting(Program& program, const Mechanics& mechanics) {
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
  program.coefficients = lowering.statements(0);
  program.potential_gradient.statements = lowering.statements(1);
  program.kinetic_gradient.statements = lowering.statements(2);
  for (int i = 0; i < 2 * n; ++i) {
    (i < n ? program.potential_gradient : program.kinetic_gradient)
        .results.push_back(lowering.wanted(handles[static_cast<std::size_t>(i)]));
  }
}

// J grad H from grad H = (H_q, H_p).
Evaluation rotated(const Evaluation& gradient) {
  Evaluation field{.statements = gradient.statements};
  const auto middle = gradient.results.begin() + std::ssize(gradient.results) / 2;
  field.results.assign(middle, gradient.results.end());
  for (auto it = gradient.results.begin(); it != middle; ++it) field.results.push_back(-*it);
  return field;
}

void build_hessian(Program& program, const Mechanics& mechanics) {
  std::vector<Expression> values;
  for (const auto& [place, value] : mechanics.hessian) {
    program.hessian_places.push_back(place);
    values.push_back(value);
  }
  program.hessian = evaluate_together(values);
}

}  // namespace

Program with_tangent(Program program) {
  program.tangent = true;
  const StepEquations& equations = program.plan.equations;
  const bool solved = equations.scheme.has_member() && !program.plan.sweeps;
  if (program.plan.arrays) {
    // Of a fixed point, too, the linearised equations are solved by elimination.
    ArrayPlan& arrays = *program.plan.arrays;
    if (iterates(arrays) && !arrays.matrix) {
      const FamilyParameters member = uniform_parameters(equations.scheme.member()).value();
      arrays.matrix = choose_matrix(equations.mechanics, member, arrays.reduced);
    }
  } else if (solved) {
    program.linearisation = linearise(program.plan);
  } else if (program.hessian_places.empty()) {
    build_hessian(program, equations.mechanics);
  }
  return program;
}

Program build_program(const SolvePlan& plan) {
  const Mechanics& mechanics = plan.equations.mechanics;
  Program program{.plan = plan};
  if (!plan.arrays) {
    if (plan.equations.scheme.has_member()) program = StepBuilder(plan).build();
    if (std::holds_alternative<Splitting>(plan.equations.scheme.method)) {
      build_splitting(program, mechanics);
    }
    if (plan.stage_solver) build_hessian(program, mechanics);
    program.energy = evaluate_together({mechanics.energy});
    program.gradient = evaluate_together(plan.equations.function ? plan.equations.energy_gradient
                                                                 : mechanics.gradient);
    if (std::holds_alternative<RungeKutta>(plan.equations.scheme.method)) {
      program.vector_field = rotated(program.gradient);
    }
  }
  program.sequence = sequence_of(plan.equations.scheme);
  std::vector<Expression> invariants;
  std::vector<Expression> events;
  for (const NamedExpression& each : mechanics.invariants)
    (each.is_event() ? events : invariants).push_back(each.value);
  program.invariants = evaluate_together(invariants);
  program.events = evaluate_together(events);
  return program;
}

}  // namespace hamgen
