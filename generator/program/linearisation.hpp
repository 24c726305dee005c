// The linearised step: how a displacement u of z moves Z.  Its equations
//
//   dzbar = u + h B H''(zbar) dzbar,   dZ = u + h J H''(zbar) dzbar,   B = (I/2 + C) J
//
// are solved as the step's own are: in the order of its blocks, what the step tears out eliminated
// first, with the matrix of its Newton iteration taken at the solution.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/program/statement.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

// matrix solution = right_side.
struct LinearisedSolve {
  std::vector<std::vector<Expression>> matrix;  // m x m, the same for all displacements
  std::vector<Expression> right_side;
  std::vector<std::string> solution;  // symbols
};

// Symbols: the state, "dz(q)" for the step Z - z that was taken, "u(q)" for the displacement.
struct Linearisation {
  struct Stage {
    std::vector<Statement> before;
    std::optional<LinearisedSolve> solve;
  };
  std::vector<Statement> once;      // for all displacements
  std::vector<Stage> stages;        // for each, in order
  std::vector<Expression> results;  // dZ, 2n
};

// Of a member that is solved.
[[nodiscard]] Linearisation linearise(const SolvePlan& plan);

}  // namespace hamgen
