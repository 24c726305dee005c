// What stands around the routines in a C header, as this step needs it: written down from what a
// step is, not from what prints it.
#pragma once

#include <vector>

#include "generator/readback/shell.hpp"

namespace hamgen {

// In the words of CNames::text.
[[nodiscard]] Pattern c_record_pattern(const Record& record);
[[nodiscard]] Pattern c_defaults_pattern(const Record& parameters);
[[nodiscard]] Pattern c_start_pattern(const Record& start);
// The record of the Propagator and its functions, and the function step.
[[nodiscard]] std::vector<ShellPart> c_propagator_parts(const Propagator& propagator);
[[nodiscard]] Pattern c_step_pattern();

}  // namespace hamgen
