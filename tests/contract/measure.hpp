// Emitted double (or float, or long double) steps against emitted quad steps: one program for many
// models and methods.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "generator/pipeline.hpp"

namespace hamgen::contract {

// What to run.  A Runge-Kutta method takes its equations from its tableau, a member from alpha,
// beta, gamma here, which must be those of the request.
struct Case {
  std::string name;
  SourceText model;
  std::string scene = "";
  Request request = {};
  std::string alpha = "1/2", beta = "0", gamma = "0";  // rational numbers
  long steps = 0;                                      // 0: the scene's
};

// What step_defect.hpp found along a run: see Note [contract of a solve] there.
struct Defects {
  std::string name;
  long long steps = 0;       // that were taken
  long long solves = 0;      // of equations: a composition has several a step
  long long iterations = 0;  // of all solves
  double worst = 0;          // largest |Z - Z_quad| / (|A^-1| r + eps |Z|): 16 is allowed
  long long worst_step = 0;
  double units = 0;       // largest |Z - Z_quad| / (eps max|Z|)
  double reference = 0;   // largest doubt of Z_quad, in parts of the bound
  bool failed = false;    // the run ended with a step without a solution
  long long broken = 0;   // solves beyond 16
  long long unknown = 0;  // solves whose quad step finds no solution: not judged
};

// One translation unit that runs all cases and prints what read_defects reads.  `edit` may change
// the text of the emitted code that is measured, not of the quad code.
[[nodiscard]] std::string program(const std::vector<Case>& cases,
                                  const std::function<std::string(std::string)>& edit = {});
[[nodiscard]] std::vector<Defects> read_defects(const std::string& output);

// Compiles and runs the program; throws std::runtime_error with the compiler's words.
[[nodiscard]] std::vector<Defects> measure(
    const std::vector<Case>& cases, const std::function<std::string(std::string)>& edit = {});

// A model of tests/contract/models.hpp, or a shipped one.
[[nodiscard]] SourceText model(const std::string& name);

}  // namespace hamgen::contract
