// All routines of a program.
#pragma once

#include <string_view>
#include <vector>

#include "generator/program/code.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

[[nodiscard]] std::vector<Routine> routines_of(const Program& program);
// The one of this name, or null.
[[nodiscard]] const Routine* find_routine(const std::vector<Routine>& routines,
                                          std::string_view name);

}  // namespace hamgen
