// What stands around the routines in a C header, as this step needs it: written down from what a
// step is, not from what prints it.
#pragma once

#include <map>
#include <string>

#include "generator/readback/pattern.hpp"
#include "generator/readback/shell.hpp"

namespace hamgen {

// In the words of CNames::text.
[[nodiscard]] Pattern c_record_pattern(const Record& record);
[[nodiscard]] Pattern c_defaults_pattern(const Record& parameters);
// The functions and records of the Propagator by their names: "Propagator_step".
[[nodiscard]] std::map<std::string, Pattern> c_propagator_patterns(const ShellFacts& facts);

}  // namespace hamgen
