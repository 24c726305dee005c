// Routines in the words of a dialect.
#pragma once

#include <set>
#include <string>

#include "generator/base/code_writer.hpp"
#include "generator/formats/dialect.hpp"
#include "generator/program/code.hpp"

namespace hamgen {

// What was used, for the lines before the routines.
struct Used {
  std::set<std::string> functions;  // of <cmath>
  bool pi = false;
};

void print(CodeWriter& out, const Routine& routine, const Dialect& dialect, Used& used);

}  // namespace hamgen
