#include "generator/formats/cpp_preamble.hpp"

#include <fmt/format.h>

#include <algorithm>

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

void write_gradient_cost(CodeWriter& out, const Program& program) {
  std::vector<Statement> all = program.gradient.statements;
  for (const Expression& result : program.gradient.results) all.push_back({"", result});
  out.line("//   cost      per gradient: " + to_text(cost(all)));
}

}  // namespace

void write_preamble(CodeWriter& out, const CppContext& context) {
  const Scheme& scheme = context.equations.scheme;
  const SolvePlan& plan = context.program.plan;
  out.remark("// ", fmt::format("{}, {}.  Generated: change the model, not this file.",
                                context.mechanics.name, scheme.name));
  out.line("//");
  out.line(fmt::format("//   made by   hamgen {}, in C++17", HAMGEN_VERSION));
  const CppOptions& options = context.options;
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
  if (!options.proved.empty()) out.comment("//   proved    ", options.proved);
  if (!options.tested.empty()) out.comment("//   tested    ", options.tested);
  if (!options.refuted.empty()) out.comment("//   refuted   ", options.refuted);
  out.comment("//   solve     ", plan.solver);
  bool first = true;
  for (const std::string& item : plan.left_out) {
    out.comment(first ? "//   left out  " : "//             ", item);
    first = false;
  }
  if (context.arrays()) return;
  if (scheme.has_member()) {
    write_cost(out, context.program);
  } else {
    write_gradient_cost(out, context.program);
  }
}

}  // namespace hamgen
