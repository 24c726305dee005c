// The functions of a large system: loops over kernels.
#include "generator/formats/cpp_arrays.hpp"

namespace hamgen {

void write_array_functions(CodeWriter& out, CppContext& context) {
  const SolvePlan& plan = context.program.plan;
  const ArrayPlan& arrays = *plan.arrays;
  const Method& method = context.equations.scheme.method;
  const bool whole =
      arrays.method == ArrayMethod::gradient_only && !std::holds_alternative<Splitting>(method);
  for (const char* name : {"energy", "potential_gradient", "kinetic_gradient"}) {
    context.write_routine(out, name);
  }
  if (!context.mechanics.is_separable() || whole || context.options.gradient) {
    context.write_routine(out, "gradient");
  }
  context.write_routine(out, "masses");
  if (arrays.matrix) write_array_matrix(out, *arrays.matrix);
  const bool newton_on_stages = plan.stage_solver && *plan.stage_solver != StageSolver::fixed_point;
  if (arrays.matrix || newton_on_stages || context.options.tangent) {
    context.write_routine(out, "hessian");
  }
}

}  // namespace hamgen
