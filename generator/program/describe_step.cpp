#include "generator/program/describe_step.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/program/code_cost.hpp"

namespace hamgen {

namespace {

Cost sum(Cost total, const Cost& more) {
  total.additions += more.additions;
  total.multiplications += more.multiplications;
  total.divisions += more.divisions;
  total.functions += more.functions;
  return total;
}

std::string cost_text(const StepCost& cost) {
  if (cost.iteration == Cost{}) return "per step: " + to_text(cost.besides);
  return fmt::format("per iteration: {}; per step besides: {}", to_text(cost.iteration),
                     to_text(cost.besides));
}

StepCost cost_of_stages(const LoweredStep& lowered) {
  StepCost total;
  for (const Stage& stage : lowered.stages) {
    total.besides = sum(sum(total.besides, cost(stage.before)), cost(stage.after));
    if (stage.solve) total.iteration = sum(total.iteration, cost(stage.solve->body));
  }
  return total;
}

Cost cost_of_gradient(const LoweredStep& lowered) {
  std::vector<Statement> all = lowered.gradient.statements;
  for (const Expression& result : lowered.gradient.results) all.push_back({"", result});
  return cost(all);
}

Cost cost_of_gradient_in_loops(const Program& program) {
  if (program.routine("potential_gradient") == nullptr) return routine_cost(program, "gradient");
  return sum(routine_cost(program, "potential_gradient"),
             routine_cost(program, "kinetic_gradient"));
}

std::string cost_text(const LoweredStep& lowered, const Program& program) {
  const bool arrays = program.environment.arrays;
  if (lowered.plan.equations.scheme.has_member())
    return cost_text(arrays ? step_cost(program) : cost_of_stages(lowered));
  return "per gradient: " +
         to_text(arrays ? cost_of_gradient_in_loops(program) : cost_of_gradient(lowered));
}

// "(q + Q)/2" for alpha = 1/2: (1 - alpha) z + alpha Z.
std::string between(const Expression& alpha, const char* z, const char* Z) {
  if (alpha == Expression(0)) return z;
  if (alpha == Expression(1)) return Z;
  if (alpha == Expression(Rational(1, 2))) return fmt::format("({} + {})/2", z, Z);
  const auto times = [](const Expression& factor, const char* x) {
    const std::string text = to_text(factor);
    const bool sum = text.find_first_of("+-", 1) != std::string::npos;
    return fmt::format(fmt::runtime(sum ? "({})*{}" : "{}*{}"), text, x);
  };
  return times(Expression(1) - alpha, z) + " + " + times(alpha, Z);
}

std::string push(const Expression& factor, const char* difference) {
  return factor.is_zero() ? "" : fmt::format(" - ({})*({})", to_text(factor), difference);
}

std::string member_equations(const Member& member) {
  const char* function = member.generating_order > 0 ? "K" : "H";
  const std::string raised =
      member.generating_order > 0 ? ", K(z, h) a modified Hamiltonian in place of H" : "";
  const auto parameters = uniform_parameters(member);
  const auto is_long = [](const Expression& e, std::size_t most) {
    return to_text(e).size() > most;
  };
  if (!parameters || is_long(parameters->alpha, 40) || is_long(parameters->beta, 80) ||
      is_long(parameters->gamma, 80)) {
    return fmt::format("Z = z + h J grad {}(zbar), zbar = (z + Z)/2 + C (Z - z), z = (q, p){}",
                       function, raised);
  }
  const auto& [alpha, beta, gamma] = *parameters;
  return fmt::format("Q = q + h d{0}/dp, P = p - h d{0}/dq at qbar = {1}{2}, pbar = {3}{4}{5}",
                     function, between(alpha, "q", "Q"), push(gamma, "P - p"),
                     between(Expression(1) - alpha, "p", "P"), push(beta, "Q - q"), raised);
}

std::string equations_of(const Scheme& scheme) {
  if (scheme.is_member()) return member_equations(scheme.member());
  if (const auto* composition = std::get_if<Composition>(&scheme.method)) {
    return fmt::format("{}, {} times in turn, with parts of h", member_equations(composition->base),
                       composition->substeps.size());
  }
  if (std::holds_alternative<Splitting>(scheme.method)) {
    return "p -= b h dV/dq (kick) and q += a h dT/dp (drift) in turn, H = T(p) + V(q)";
  }
  return "Z = z + h sum b_i f(Y_i), Y_i = z + h sum a_ij f(Y_j), f = (dH/dp, -dH/dq), z = (q, p)";
}

// Sweeps leave the equations unsolved: what the scheme is, the step is not.
std::string properties_of(const Scheme& scheme, bool solved) {
  const bool raised = scheme.is_member() && scheme.member().generating_order > 0;
  return fmt::format("{}: order {}{}{}{}", scheme.description, scheme.order,
                     raised ? " by generating function" : "",
                     scheme.symmetric && solved ? ", symmetric" : "",
                     scheme.symplectic && solved ? ", symplectic" : ", not symplectic");
}

std::vector<Quantity> invariants_of(const LoweredStep& lowered) {
  std::vector<Quantity> list;
  for (const NamedExpression& each : lowered.plan.equations.mechanics.invariants) {
    if (!each.is_event()) list.push_back({each.name, "", each.comment, 0});
  }
  for (const int power : lowered.modified_powers)
    list.push_back({fmt::format("modified_energy_{}", power), "", "", 0});
  return list;
}

bool needs_eigen(const LoweredStep& lowered) {
  if (lowered.plan.arrays) return uses_eigen(*lowered.plan.arrays);
  return std::ranges::any_of(lowered.stages, [](const Stage& stage) {
    return stage.solve && stage.solve->linear_solver == LinearSolver::eigen_dense;
  });
}

std::string solver_text(const LoweredStep& lowered) {
  std::string text = lowered.plan.solver;
  if (lowered.plan.ahead) text += "; " + std::string(kAhead);
  if (lowered.second_order) text += "; momenta eliminated";
  const int packs = lowered.stage_layout ? lowered.stage_layout->packs() : 0;
  if (packs > 0) text += fmt::format("; stages in {} lanes", packs);
  return text;
}

std::string in_one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

}  // namespace

StepFacts describe_step(const LoweredStep& lowered, const Program& program) {
  const Mechanics& mechanics = lowered.plan.equations.mechanics;
  const Scheme& scheme = lowered.plan.equations.scheme;
  StepFacts facts{.system = mechanics.name,
                  .hamiltonian = in_one_line(mechanics.hamiltonian_text),
                  .definitions = mechanics.definitions,
                  .has_time = mechanics.has_time,
                  .constants = mechanics.constants,
                  .invariants = invariants_of(lowered),
                  .modified_powers = lowered.modified_powers,
                  .scheme = scheme.name,
                  .properties = properties_of(scheme, !lowered.plan.sweeps),
                  .equations = equations_of(scheme),
                  .solver = solver_text(lowered),
                  .left_out = lowered.plan.left_out,
                  .cost = cost_text(lowered, program),
                  .needs_eigen = needs_eigen(lowered)};
  for (auto& [name, text] : facts.definitions) text = in_one_line(text);
  return facts;
}

}  // namespace hamgen
