// Routines as C++.
#pragma once

#include <set>
#include <string>

#include "generator/formats/code_writer.hpp"
#include "generator/formats/scalar.hpp"
#include "generator/program/code.hpp"

namespace hamgen {

// How a target spells what all of them have.
struct Dialect {
  const ScalarType& scalar;
  bool builtins = false;  // functions of the compiler instead of <cmath>
  int n = 0;              // degrees of freedom, where the text has a constant of that name
};

// What was used, for the lines before the routines.
struct Used {
  std::set<std::string> functions;  // of <cmath>
  bool pi = false;
};

void print(CodeWriter& out, const Routine& routine, const Dialect& dialect, Used& used);

}  // namespace hamgen
