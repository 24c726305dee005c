// The values of all stages.
#pragma once

#include "generator/equations/step_equations.hpp"
#include "generator/pipeline.hpp"
#include "generator/program/program.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

struct Stages {
  Model model;  // as the request reads it
  FoldedModel folded;
  Specialised system;
  StepEquations equations;
  SolvePlan plan;
  Program program;
};

// One after the other: the only place that knows their order.
[[nodiscard]] Stages run_stages(const SourceText& source, const Request& request);

// Was anything left out because the scene does not need it?
[[nodiscard]] bool is_something_left_out(const Stages& stages);
// H of the step's system with its sums written out.
[[nodiscard]] Expression written_out_hamiltonian(const Stages& stages);

// What algebra can say of the step; `scene` is that of a run that changes one.
[[nodiscard]] Proof prove(const SourceText& source, const Request& request, const Stages& stages,
                          const std::optional<SceneValues>& scene = {});

}  // namespace hamgen
