#include "generator/formats/preamble.hpp"

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

void write_cost(CodeWriter& out, const Program& program) {
  Cost straight;
  Cost iteration;
  for (const Stage& stage : program.stages) {
    straight = sum(sum(straight, cost(stage.before)), cost(stage.after));
    if (stage.solve) iteration = sum(iteration, cost(stage.solve->body));
  }
  if (iteration == Cost{}) {
    out.line("//   cost      per step: " + to_text(straight));
  } else {
    out.line(fmt::format("//   cost      per iteration: {}; per step besides: {}",
                         to_text(iteration), to_text(straight)));
  }
}

void write_cost_of_loops(CodeWriter& out, const EmitContext& context) {
  if (!context.equations.scheme.has_member()) {
    const Cost gradient = context.code.routine("potential_gradient") == nullptr
                              ? routine_cost(context.code, "gradient")
                              : sum(routine_cost(context.code, "potential_gradient"),
                                    routine_cost(context.code, "kinetic_gradient"));
    return out.line("//   cost      per gradient: " + to_text(gradient));
  }
  const StepCost step = step_cost(context.code);
  if (step.iteration == Cost{}) {
    out.line("//   cost      per step: " + to_text(step.besides));
  } else {
    out.line(fmt::format("//   cost      per iteration: {}; per step besides: {}",
                         to_text(step.iteration), to_text(step.besides)));
  }
}

void write_gradient_cost(CodeWriter& out, const Program& program) {
  std::vector<Statement> all = program.gradient.statements;
  for (const Expression& result : program.gradient.results) all.push_back({"", result});
  out.line("//   cost      per gradient: " + to_text(cost(all)));
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
  if (!parameters || to_text(parameters->alpha).size() > 40) {
    return fmt::format("Z = z + h J grad {}(zbar), zbar = (z + Z)/2 + C (Z - z), z = (q, p){}",
                       function, raised);
  }
  const auto& [alpha, beta, gamma] = *parameters;
  return fmt::format("Q = q + h d{0}/dp, P = p - h d{0}/dq at qbar = {1}{2}, pbar = {3}{4}{5}",
                     function, between(alpha, "q", "Q"), push(gamma, "P - p"),
                     between(Expression(1) - alpha, "p", "P"), push(beta, "Q - q"), raised);
}

// The equations of a step from z = (q, p) to Z = (Q, P).
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

}  // namespace

void write_preamble(CodeWriter& out, const EmitContext& context) {
  const Scheme& scheme = context.equations.scheme;
  const SolvePlan& plan = context.program.plan;
  out.remark("// ", fmt::format("{}, {}.  Generated: change the model, not this file.",
                                context.mechanics.name, scheme.name));
  out.line("//");
  out.line(
      fmt::format("//   made by   hamgen {}, in {}", HAMGEN_VERSION, context.dialect.language()));
  const EmitOptions& options = context.options;
  if (!options.command.empty()) out.remark("//   command   ", options.command);
  if (!options.model_path.empty()) out.remark("//   model     ", options.model_path);
  if (!options.model_digest.empty()) out.remark("//   sha256    ", options.model_digest);
  std::string formula = context.mechanics.hamiltonian_text;
  std::ranges::replace(formula, '\n', ' ');
  out.comment(context.mechanics.has_time ? "//   H(q, p, t) = " : "//   H(q, p) = ", formula);
  const bool symplectic = scheme.symplectic && !plan.sweeps;
  const bool raised = scheme.is_member() && scheme.member().generating_order > 0;
  out.remark("//   scheme    ", fmt::format("{}: order {}{}{}{}", scheme.description, scheme.order,
                                            raised ? " by generating function" : "",
                                            scheme.symmetric && !plan.sweeps ? ", symmetric" : "",
                                            symplectic ? ", symplectic" : ", not symplectic"));
  out.comment("//   step      ", equations_of(scheme));
  if (!options.proved.empty()) out.comment("//   proved    ", options.proved);
  if (!options.tested.empty()) out.comment("//   tested    ", options.tested);
  if (!options.refuted.empty()) out.comment("//   refuted   ", options.refuted);
  out.comment("//   solve     ", plan.solver);
  if (options.lanes > 0) {
    out.comment(
        "//   batch     ",
        fmt::format("{} trajectories in lanes, functions {}; compile with -ffp-contract=off",
                    options.lanes, options.library_functions ? "of <cmath>" : "below"));
  }
  bool first = true;
  for (const std::string& item : plan.left_out) {
    out.comment(first ? "//   left out  " : "//             ", item);
    first = false;
  }
  if (context.arrays()) {
    write_cost_of_loops(out, context);
  } else if (scheme.has_member()) {
    write_cost(out, context.program);
  } else {
    write_gradient_cost(out, context.program);
  }
}

}  // namespace hamgen
