#include "generator/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "generator/algebra/scalar.hpp"
#include "generator/base/budget.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/choose_sums.hpp"
#include "generator/choose_system.hpp"
#include "generator/emit_files.hpp"
#include "generator/emitted_text.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/program/build_program.hpp"
#include "generator/read_request.hpp"
#include "generator/step_wishes.hpp"

namespace hamgen {

namespace {

// Parameters that serve a scene only, or nothing: no emitted line names them.
void drop_unused_parameters(StepEquations& equations) {
  Mechanics& mechanics = equations.mechanics;
  if (mechanics.keeps_sums()) return;
  std::set<std::string> used;
  collect_symbols(mechanics.energy, used);
  for (const Expression& component : mechanics.gradient) collect_symbols(component, used);
  for (const auto& [place, value] : mechanics.hessian) collect_symbols(value, used);
  for (const NamedExpression& invariant : mechanics.invariants) {
    collect_symbols(invariant.value, used);
  }
  for (const auto& [place, value] : equations.stage_matrix) collect_symbols(value, used);
  std::erase_if(mechanics.parameters,
                [&](const Quantity& parameter) { return !used.contains(parameter.name); });
}

void prepend(std::vector<std::string>& list, const std::vector<std::string>& first) {
  list.insert(list.begin(), first.begin(), first.end());
}

Stages stages_of(Model model, const Request& request) {
  require_defaults_in_range(model, *request.scalar->type);
  FoldedModel folded = fold_for_scene(model, request);
  const std::optional<SceneFacts> scene = scene_facts(model, request);
  Specialised system = choose_system(folded.model, scene, request);
  const HessianWish hessian = request.tangent ? HessianWish::exact : HessianWish::cheapest;
  StepEquations equations = discretise(system.mechanics, system.scheme, hessian);
  const auto numbers =
      request.scalar->type->digits < 113 ? NumbersOf::processor : NumbersOf::library;
  SolvePlan plan = plan_solve(equations, request.solver, numbers);
  drop_unused_parameters(plan.equations);
  equations.mechanics.parameters = plan.equations.mechanics.parameters;
  system.mechanics.parameters = plan.equations.mechanics.parameters;
  prepend(plan.left_out, system.left_out);
  prepend(plan.left_out, folded.folding.left_out);
  const StepWishes wishes = step_wishes(request, system, plan, scene.has_value());
  std::ranges::move(left_out_by(wishes), std::back_inserter(plan.left_out));
  Program program = build_program(plan, wishes);
  return {std::move(model),     std::move(folded), std::move(system),
          std::move(equations), std::move(plan),   std::move(program)};
}

}  // namespace

Stages run_stages(const SourceText& source, const Request& request) {
  const Budget budget;
  const Model model = read_request(source, request);
  try {
    return stages_of(model, request);
  } catch (const OverBudget& error) {
    const std::string wish = wish_for_all_second_derivatives(request);
    throw over_budget(error, model.hamiltonian->span, source,
                      wish.empty() ? ""
                                   : "; " + wish +
                                         " needs them all: without it a function of "
                                         "sums keeps these as loops");
  }
}

bool is_something_left_out(const Stages& stages) {
  return !stages.folded.folding.left_out.empty() || !stages.system.left_out.empty();
}

Expression written_out_hamiltonian(const Stages& stages) {
  const Specialised& system = stages.system;
  return system.mechanics.keeps_sums() ? restrict_to(written_out_hamiltonian(stages.folded.model),
                                                     system.whole, system.kept, system.left)
                                       : system.mechanics.energy;
}

OutputFiles generate(const SourceText& source, const Request& request) {
  const Stages stages = run_stages(source, request);
  EmitOptions options = options_with_tangent(source, stages, request);
  add_proof(source, stages, request, files_of(stages, options, request), options);
  return files_of(stages, options, request);
}

OutputFiles emit(const SourceText& source, const Request& request) {
  const Stages stages = run_stages(source, request);
  return files_of(stages, options_with_tangent(source, stages, request), request);
}

std::string show_stage(const SourceText& source, const Request& request, const std::string& stage) {
  if (stage == "model")
    return to_text(fold_for_scene(read_request(source, request), request).model);
  if (stage == "mechanics" && !request.scene) return to_text(derive(read_request(source, request)));
  const Stages stages = run_stages(source, request);
  if (stage == "mechanics") return to_text(stages.system.mechanics);
  if (stage == "equations") return to_text(stages.equations);
  if (stage == "plan") return to_text(stages.plan);
  if (stage == "program") return to_text(stages.program);
  if (stage == "origins") {
    return text_with_origins(stages.program, stages.system.mechanics.terms);
  }
  throw UsageError(fmt::format(
      "unknown stage '{}'; there are model, mechanics, equations, plan, program, origins", stage));
}

void check_step(const SourceText& source, const Request& request) {
  const Stages stages = run_stages(source, request);
  static_cast<void>(header_text(stages, emit_options(source, stages, request), request));
}

Proof verify_step(const SourceText& source, const Request& request,
                  const std::optional<SceneValues>& scene,
                  const std::optional<EmittedHeader>& header) {
  const Stages stages = run_stages(source, request);
  Proof proof = prove(source, request, stages, scene);
  const ReadBack read = read_file(header, source, stages, request);
  add_emitted_code(read, header ? header->path : "", proof);
  if (header || read.kind != TextKind::plugin) {
    Request run = request;
    run.format = "cpp-plugin";
    run.support = "";
    run.events = false;  // a plugin has none, and no lanes
    run.batch = 0;
    run.math = {};
    const std::optional<Stages> of_run =
        request.events || request.batch > 0 ? std::optional(run_stages(source, run)) : std::nullopt;
    add_plugin(read_file({}, source, of_run ? *of_run : stages, run), proof);
  }
  return proof;
}

ReadBack read_emitted(const SourceText& source, const Request& request,
                      const std::optional<EmittedHeader>& header) {
  return read_file(header, source, run_stages(source, request), request);
}

Program make_program(const SourceText& source, const Request& request) {
  return run_stages(source, request).program;
}

}  // namespace hamgen
