// The functions of the state alone.
#pragma once

#include <string>
#include <vector>

#include "generator/program/environment.hpp"
#include "generator/program/lowered_step.hpp"

namespace hamgen {

// How a function is given the state: as a record, or as an array of its 2n components.
enum class StateForm { record, array };

// number name(par, z)
[[nodiscard]] Routine number_routine(const Environment& environment, std::string name,
                                     const Evaluation& evaluation);
// name(par, z, values), values[i] = result i; the value 0 stands for one that nobody reads and is
// left out if `sparse`.
[[nodiscard]] Routine values_routine(const Environment& environment, std::string name,
                                     const Evaluation& evaluation,
                                     StateForm form = StateForm::record, bool sparse = false);
// The same at all stages, in the arrays z and values of such a layout; result 0 is the component
// `first` of values.
[[nodiscard]] Routine stage_values_routine(const Environment& environment, std::string name,
                                           const Evaluation& evaluation, const StageLayout& layout,
                                           int first = 0);
// hessian(par, z, values), values[i][j] and values[j][i] for the places of the entries.
[[nodiscard]] Routine hessian_routine(const Environment& environment, const Evaluation& entries,
                                      const std::vector<std::pair<int, int>>& places,
                                      StateForm form);

}  // namespace hamgen
