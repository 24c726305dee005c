// The program of a system whose sums stay loops, as text.
#pragma once

#include <string>

#include "generator/program/program.hpp"

namespace hamgen {

[[nodiscard]] std::string loops_text(const Program& program);

}  // namespace hamgen
