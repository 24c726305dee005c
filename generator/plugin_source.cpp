// What a run needs to know of an emitted plugin.
#include <fmt/format.h>

#include "generator/algebra/scalar.hpp"
#include "generator/emit_files.hpp"
#include "generator/program/code_cost.hpp"
#include "generator/program/without_tangent.hpp"

namespace hamgen {

PluginSource generate_plugin(const SourceText& source, const Request& request, HeaderText header) {
  if (request.events) {  // found by who runs it
    Request plain = request;
    plain.events = false;
    return generate_plugin(source, plain, header);
  }
  Stages stages = run_stages(source, request);
  EmitOptions options = emit_options(source, stages, request);
  PluginSource plugin;
  // What is compiled does not depend on values that are given at run time.
  EmitOptions anonymous = options;
  anonymous.command.clear();
  plugin.text = plugin_text(stages, anonymous, request);
  if (header == HeaderText::with_proof) {
    const OutputFiles files = {{options.file_name + ".hpp", header_text(stages, options, request)}};
    add_proof(source, stages, request, files, options);
  }
  if (header != HeaderText::none)
    plugin.header = {options.file_name + ".hpp", header_text(stages, options, request)};
  plugin.scheme_name = stages.equations.scheme.name;
  if (plugin.scheme_name.starts_with("member")) {
    plugin.scheme_name = stages.equations.scheme.description;
    if (request.order > 0) plugin.scheme_name += fmt::format(", order {}", request.order);
  }
  plugin.order = stages.equations.scheme.order;
  plugin.solver = stages.program.facts.solver;
  plugin.is_swept = stages.plan.sweeps.has_value();
  plugin.left_out = stages.plan.left_out;
  plugin.left_out_for_scene = stages.folded.folding.left_out.size() + stages.system.left_out.size();
  for (const Quantity& parameter : stages.system.mechanics.parameters) {
    plugin.parameter_names.push_back(parameter.name);
  }
  plugin.state = state_map(stages.system);
  plugin.same = stages.folded.folding.same;
  for (const LinearChange& change : stages.system.changes)
    plugin.same.insert(plugin.same.end(), change.united.begin(), change.united.end());
  plugin.whole_energy = stages.system.left.dropped.empty();
  plugin.for_scene = request.scene.has_value();
  plugin.needs_energy_parameter = uses_energy_parameter(stages.equations);
  if (plugin.needs_energy_parameter) plugin.parameter_names.emplace_back("E0");
  for (const NamedExpression& invariant : stages.system.mechanics.invariants) {
    plugin.invariant_names.push_back(invariant.name);
  }
  for (const int power : stages.program.facts.modified_powers)
    plugin.invariant_names.push_back(fmt::format("modified_energy_{}", power));
  plugin.without_tangent = without_tangent(stages.plan).value_or("");
  plugin.singular_steps = singular_steps(stages.equations.scheme);
  plugin.operations_per_step = operations_per_step(stages.program);
  plugin.has_stages = std::holds_alternative<RungeKutta>(stages.equations.scheme.method);
  plugin.in_loops = stages.program.environment.arrays;
  plugin.needs_eigen = stages.program.facts.needs_eigen;
  plugin.needs_quadmath = request.scalar->type->digits == 113;
  plugin.model = std::move(stages.model);
  return plugin;
}

}  // namespace hamgen
