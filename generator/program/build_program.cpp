#include "generator/program/build_program.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/program/alone.hpp"
#include "generator/program/coefficients.hpp"
#include "generator/program/describe_step.hpp"
#include "generator/program/function_routines.hpp"
#include "generator/program/kernel_routines.hpp"
#include "generator/program/loop_member.hpp"
#include "generator/program/method_tangents.hpp"
#include "generator/program/names.hpp"
#include "generator/program/origins.hpp"
#include "generator/program/plain_sums.hpp"
#include "generator/program/propagator.hpp"
#include "generator/program/runge_kutta_routine.hpp"
#include "generator/program/solve_routine.hpp"
#include "generator/program/split_constants.hpp"
#include "generator/program/splitting_routine.hpp"
#include "generator/program/stage_routines.hpp"
#include "generator/program/start_record.hpp"
#include "generator/program/tangent_routine.hpp"

namespace hamgen {

namespace {

Routine with_remark(Routine routine, std::string remark) {
  routine.remark = {std::move(remark)};
  return routine;
}

Routine modified_energies(const Environment& environment, const LoweredStep& lowered) {
  Routine routine = values_routine(environment, "modified_energies", lowered.modified_energies);
  routine.arguments.insert(routine.arguments.begin() + 1, {.name = "h"});
  const std::vector<int>& powers = lowered.modified_powers;
  std::string list;
  for (const int power : powers) list += fmt::format("{}h^{}", list.empty() ? "" : ", ", power);
  routine.remark = {fmt::format("The modified Hamiltonian H + h^{} (...) + ..., which steps of "
                                "size h conserve as a formal",
                                powers.front()),
                    fmt::format("series, cut off after {}.", list)};
  return routine;
}

Routine invariants(const Environment& environment, const LoweredStep& lowered) {
  std::string list;
  for (const NamedExpression& i : lowered.plan.equations.mechanics.invariants) {
    if (!i.is_event()) list += (list.empty() ? "" : ", ") + i.name;
  }
  return with_remark(values_routine(environment, "invariants", lowered.invariants),
                     "The model's invariants: " + list + ".");
}

void add_events(Program& code, const Environment& environment, const LoweredStep& lowered) {
  std::string list;
  for (const NamedExpression& each : lowered.plan.equations.mechanics.invariants) {
    if (!each.is_event()) continue;
    const char* direction = each.rising && each.falling ? "" : each.rising ? " rising" : " falling";
    list += (list.empty() ? "" : ", ") + each.name + direction;
    code.events.push_back({member_identifier(each.name), each.rising, each.falling});
  }
  if (code.events.empty()) return;
  code.routines.push_back(with_remark(values_routine(environment, "events", lowered.events),
                                      "Values whose zeros are the events: " + list + "."));
}

// The functions of the state of a system in loops.
void add_kernel_functions(Program& code, const Environment& environment,
                          const LoweredStep& lowered) {
  const SolvePlan& plan = lowered.plan;
  const Mechanics mechanics = plan.equations.of_energy();
  code.routines.push_back(kernel_energy(environment, mechanics));
  const auto add_gradient = [&](const char* name, Part part) {
    code.routines.push_back(
        kernel_gradient(environment, mechanics, name, part, splits_constants(plan)));
  };
  if (mechanics.is_separable()) {
    add_gradient("potential_gradient", Part::potential);
    add_gradient("kinetic_gradient", Part::kinetic);
    code.routines.push_back(both_gradients(environment));
  } else {
    add_gradient("gradient", Part::all);
  }
  if (plan.equations.function)
    code.routines.push_back(kernel_generating_gradient(environment, plan.equations.mechanics));
  if (const auto& layout = lowered.stage_layout; layout && layout->by_component()) {
    std::vector<Routine> leaves =
        mechanics.is_separable()
            ? std::vector{*code.routine("potential_gradient"), *code.routine("kinetic_gradient")}
            : std::vector{*code.routine("gradient")};
    for (Routine& leaf : leaves) code.routines.push_back(at_stages(std::move(leaf), *layout));
    code.routines.push_back(array_vector_fields(*layout, mechanics.is_separable()));
    if (lowered.second_order) code.routines.push_back(array_forces(*layout));
    if (lowered.second_order && !lowered.second_order->unit_mobility)
      code.routines.push_back(kernel_masses(environment, mechanics));
    code.routines.push_back(array_hessian(environment, mechanics));
  } else if (std::holds_alternative<RungeKutta>(plan.equations.scheme.method)) {
    code.routines.push_back(array_vector_field(environment));
    code.routines.push_back(array_hessian(environment, mechanics));
  }
  if (plan.arrays->reduced && !plan.arrays->mass)
    code.routines.push_back(kernel_masses(environment, mechanics));
}

// The functions of the state of a system that is written out.
void add_functions(Program& code, const Environment& environment, const LoweredStep& lowered) {
  const Mechanics& mechanics = lowered.plan.equations.mechanics;
  const bool array = std::holds_alternative<RungeKutta>(lowered.plan.equations.scheme.method);
  code.routines.push_back(
      with_remark(number_routine(environment, "energy", lowered.energy), energy_remark(mechanics)));
  if (!lowered.modified_powers.empty()) {
    code.routines.push_back(modified_energies(environment, lowered));
  }
  code.routines.push_back(with_remark(values_routine(environment, "gradient", lowered.gradient),
                                      "grad H, the derivatives by q first."));
  const std::optional<StageLayout>& layout = lowered.stage_layout;
  if (layout && layout->by_component()) {
    code.routines.push_back(with_remark(
        stage_values_routine(environment, "vector_fields", lowered.vector_field, *layout),
        "J grad H at all stages."));
    if (lowered.second_order)
      code.routines.push_back(
          with_remark(stage_values_routine(environment, "forces", lowered.second_order->forces,
                                           *layout, environment.degrees_of_freedom),
                      "-dH/dq at all stages."));
  } else if (array) {
    code.routines.push_back(with_remark(
        values_routine(environment, "vector_field", lowered.vector_field, StateForm::array),
        "J grad H at a state (q, p)."));
  }
  if (lowered.plan.equations.scheme.has_member() && !lowered.plan.sweeps) return;
  code.routines.push_back(
      with_remark(hessian_routine(environment, lowered.hessian, lowered.hessian_places,
                                  array ? StateForm::array : StateForm::record),
                  "The second derivatives of H at z."));
}

void add_member(Program& code, const Environment& environment, const LoweredStep& lowered) {
  const Coefficients coefficients = coefficients_of(environment, lowered);
  std::vector<const Solve*> solves;
  SolveParts parts{.coefficients = !coefficients.empty()};
  for (const Stage& stage : lowered.stages) {
    solves.push_back(stage.solve ? &*stage.solve : nullptr);
    if (!stage.solve) continue;
    parts.inverse = parts.inverse || is_inverted(*stage.solve);
    if (stage.solve->sweeps) continue;
    code.unknowns += static_cast<int>(stage.solve->variables.size());
  }
  parts.start = code.unknowns > 0;
  if (parts.coefficients) {
    code.records.push_back(coefficients.record);
    code.routines.push_back(coefficients.prepare);
  }
  if (parts.start) code.records.push_back(start_record(solves, code.unknowns));
  std::optional<DerivativesAhead> ahead;
  if (lowered.plan.ahead) {
    ahead = derivatives_ahead(environment, lowered, coefficients.places);
    code.records.push_back(ahead->record);
    code.routines.push_back(ahead->routine);
    parts.ahead = &*ahead;
  }
  code.routines.push_back(solve_routine(environment, lowered, parts, coefficients.places));
  code.rules = rules_of(code.routines.back());
  code.retries = code.unknowns > 0;
}

// The tangent map of the whole step.
void add_tangent(Program& code, const Environment& environment, const LoweredStep& lowered) {
  const SolvePlan& plan = lowered.plan;
  const Method& method = plan.equations.scheme.method;
  const auto add = [&](Routine routine) { code.routines.push_back(std::move(routine)); };
  if (plan.arrays && code.routine("curvature") == nullptr)
    add(curvature_routine(environment, plan.equations));
  if (std::holds_alternative<Splitting>(method))
    return add(splitting_tangent(environment, lowered));
  if (std::holds_alternative<RungeKutta>(method)) {
    return add(plan.stage_solver ? stages_tangent(environment, lowered, code)
                                 : explicit_runge_kutta_tangent(environment, lowered));
  }
  const bool composed = !lowered.sequence.substeps.empty();
  const char* name = composed ? "substep_tangent" : "tangent";
  if (plan.sweeps) {
    add(sweeps_tangent(environment, lowered, name));
  } else if (plan.arrays) {
    add(loop_member_tangent(environment, lowered, code, name));
  } else {
    const bool large = std::ranges::any_of(lowered.stages, [](const Stage& stage) {
      return stage.solve && stage.solve->linear_solver == LinearSolver::eigen_dense;
    });
    add(tangent_routine(environment, name, *lowered.linearisation, large));
  }
  if (composed) add(composition_tangent(environment, lowered, code));
}

// Of a composition.
void add_substeps(Program& code, const LoweredStep& lowered) {
  if (lowered.sequence.substeps.empty()) return;
  code.substeps.clear();
  for (const Substep& substep : lowered.sequence.substeps) {
    code.substeps.push_back(numeric_value(substep.length));
  }
}

void add_splitting(Program& code, const Environment& environment, const LoweredStep& lowered) {
  const Sequence& sequence = lowered.sequence;
  const Coefficients coefficients =
      coefficients_of(environment, lowered, splitting_lengths(sequence));
  code.records.push_back(coefficients.record);
  code.routines.push_back(coefficients.prepare);
  if (keeps_gradient(lowered)) {
    const bool kick = sequence.substeps.front().kind == SubstepKind::kick;
    code.records.push_back(
        {.name = "Start",
         .fields = {{.name = "value", .sizes = {environment.degrees_of_freedom}},
                    {.name = "known", .values = {0}, .type = "bool"}},
         .remark = {fmt::format("The {} a step ends with is the one the next begins with.",
                                kick ? "dV/dq" : "dT/dp")}});
  }
  for (Routine& routine : splitting_routines(environment, lowered, coefficients)) {
    code.routines.push_back(std::move(routine));
  }
}

// The fields of State that the places in `dz` of a routine are.
void find_changed(Program& code, const Environment& environment) {
  const Routine* solve = code.routine("solve");
  for (int i = 0; solve != nullptr && i < 2 * environment.degrees_of_freedom; ++i) {
    const Place place = environment.place("dz", i);
    const bool changes = std::ranges::any_of(solve->places, [&](const auto& entry) {
      return entry.second.object == "dz" && entry.second.field == place.field &&
             (entry.second == place || !entry.second.indices.front().factors.empty());
    });
    if (changes) code.changed.push_back(environment.place("", i));
  }
}

// An explicit step of a polynomial has a value everywhere.
void leave_unchecked(Program& code) {
  const auto solve = std::ranges::find(code.routines, "solve", &Routine::name);
  for (Instruction& instruction : solve->body) {
    auto* end = std::get_if<Return>(&instruction.value);
    if (end == nullptr || !end->success) continue;
    end->finite.clear();
    end->ranges.clear();
    code.unchecked = true;
  }
}

}  // namespace

bool Program::solve_takes(std::string_view argument) const {
  const Routine* solve = routine("solve");
  return solve != nullptr &&
         std::ranges::find(solve->arguments, argument, &Argument::name) != solve->arguments.end();
}

const Record* Program::record(std::string_view name) const {
  const auto it = std::ranges::find(records, name, &Record::name);
  return it == records.end() ? nullptr : &*it;
}

const Routine* Program::routine(std::string_view name) const {
  const auto it = std::ranges::find(routines, name, &Routine::name);
  return it == routines.end() ? nullptr : &*it;
}

std::set<std::string> callees(const Program& code, const std::string& name) {
  const Routine* routine = code.routine(name);
  if (routine == nullptr) return {};
  std::set<std::string> found = {name};
  for (const std::string& called : called_routines(routine->body)) {
    found.merge(callees(code, called));
  }
  return found;
}

Program build_program(const LoweredStep& lowered) {
  const StepEquations& equations = lowered.plan.equations;
  const Scheme& scheme = equations.scheme;
  const bool arrays = lowered.plan.arrays.has_value();
  const Environment environment = environment_of(equations, arrays);
  Program code{.records = {environment.parameter_layout.record, environment.state_layout.record},
               .routines = {},
               .changed = {},
               .environment = environment};
  if (arrays) {
    add_kernel_functions(code, environment, lowered);
  } else {
    add_functions(code, environment, lowered);
  }
  if (!lowered.invariants.results.empty()) {
    code.routines.push_back(invariants(environment, lowered));
  }
  add_events(code, environment, lowered);
  if (std::holds_alternative<Splitting>(scheme.method)) {
    add_splitting(code, environment, lowered);
  } else if (scheme.has_member()) {
    if (arrays) {
      add_loop_member(code, environment, lowered);
    } else {
      add_member(code, environment, lowered);
    }
    add_substeps(code, lowered);
  } else if (lowered.plan.stage_solver) {
    code.stages = lowered.stage_layout;
    add_stages(code, environment, lowered);
    code.retries = true;
  } else {
    add_explicit_runge_kutta(code, environment, lowered.sequence.stages);
  }
  if (lowered.unchecked) leave_unchecked(code);
  if (lowered.plain_sums) use_plain_sums(code);
  if (lowered.tangent) add_tangent(code, environment, lowered);
  find_changed(code, environment);
  trace_origins(code, environment, equations);
  code.facts = describe_step(lowered, code);
  if (arrays || code.stages) find_alone(code);
  std::ranges::for_each(code.routines, require_distinct_symbols);
  return code;
}

Program build_program(const SolvePlan& plan, const StepWishes& wishes) {
  return build_program(lower_step(plan, wishes));
}

namespace {

template <class Text>
std::string routines_as_text(const Program& code, const Text& text_of) {
  std::string text;
  for (const Record& record : code.records) text += to_text(record);
  std::set<std::string> wanted;
  for (const char* name : {"energy", "invariants", "events", "prepare", "solve", "tangent"}) {
    wanted.merge(callees(code, name));
  }
  for (const Routine& routine : code.routines) {
    if (wanted.contains(routine.name)) text += text_of(routine);
  }
  if (code.substeps.size() < 2) return text;
  text += "substeps of h times:\n";
  for (const Rational& length : code.substeps) text += fmt::format("  {}\n", length.get_d());
  return text;
}

}  // namespace

std::string to_text(const Program& code) {
  std::string text =
      routines_as_text(code, [](const Routine& routine) { return to_text(routine); });
  for (const Routine& routine : propagator_of(code).routines) text += to_text(routine);
  return text;
}

std::string text_with_origins(const Program& code, const std::vector<EnergyTerm>& terms) {
  std::string text = "H is the sum of the terms\n";
  for (std::size_t t = 0; t < terms.size(); ++t) {
    text += fmt::format("  {}  line {}: {}\n", t + 1, terms[t].line, terms[t].text);
  }
  text += routines_as_text(code, [](const Routine& routine) { return text_with_origins(routine); });
  for (const Routine& routine : propagator_of(code).routines) text += text_with_origins(routine);
  return text;
}

}  // namespace hamgen
