// What stands around the routines of an emitted C++ file, as it has to be for this step: records,
// the class that takes steps, the function that takes one.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "generator/program/contents.hpp"
#include "generator/readback/pattern.hpp"

namespace hamgen {

// `system`: the namespace of the system, whose record this one may extend.
[[nodiscard]] Pattern record_pattern(const Record& record, const std::string& system);
// The class: its routines, which are read one by one, and what stands between them.
using ShellPart = std::variant<Pattern, Routine>;
// lanes: of trajectories side by side.
[[nodiscard]] std::vector<ShellPart> propagator_parts(const Propagator& propagator, bool lanes);
// step, by a Propagator.
[[nodiscard]] Pattern step_pattern(bool lanes);
// "using Matrix = BandMatrix<8, 1>;" with what it needs.
[[nodiscard]] Pattern matrix_pattern(const ArrayMatrix& matrix);

}  // namespace hamgen
