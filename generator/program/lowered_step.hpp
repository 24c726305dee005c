// The step as straight-line single-assignment code and one loop per implicit block: what a format
// writes out.  Symbols are still mathematical ("bar(q)", "H(q)"); a format gives them its names.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/program/linearisation.hpp"
#include "generator/program/sequence.hpp"
#include "generator/program/stage_layout.hpp"
#include "generator/program/statement.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

// A variable of a solver's loop.
struct LoopVariable {
  std::string name;        // "bar(q)", or "H(q)" for sweeps
  Expression cold;         // its start value when nothing is known from earlier steps
  Expression next;         // fixed point and sweeps: the new value
  Expression correction;   // Newton, size <= 3: what is added
  bool by_torn = false;    // see Unknown
  Expression beside = {};  // what it is rounded with as well
};

// A loop.
struct Solve {
  BlockKind kind = BlockKind::newton;
  LinearSolver linear_solver = LinearSolver::written_out;
  std::optional<int> sweeps;     // a fixed number of sweeps instead of a stopping rule
  bool constant_matrix = false;  // inverted once per run
  bool simplified = false;       // Newton with an approximate matrix: linear convergence
  std::vector<LoopVariable> variables;
  std::vector<Statement> body;       // evaluated once per iteration
  std::vector<Expression> residual;  // of a linear system that is not written out: size m
  std::vector<std::vector<Expression>> matrix;  // m x m
  std::vector<std::string> corrections;         // symbols of the solution -matrix^-1 residual
  // Of a fixed point: components of the gradient, and the symbols of what they lack of their values
  // at the exact solution, for the unknowns are rounded.
  std::vector<Expression> gradient;
  std::vector<std::string> changes;
  Expression refined_beside = {};  // a length that the unknowns are rounded with besides
};

struct Stage {
  std::vector<Statement> before;  // straight-line
  std::optional<Solve> solve;
  std::vector<Statement> after;
};

// A function of the state alone.
struct Evaluation {
  std::vector<Statement> statements;
  std::vector<Expression> results;
};

struct Cost {
  long additions = 0;  // + and -
  long multiplications = 0;
  long divisions = 0;
  long functions = 0;  // sqrt, sin, pow, ...
  bool operator==(const Cost&) const = default;
};

// What a step has besides what its plan says.
struct StepWishes {
  bool tangent = false;     // is the tangent map wanted?
  bool plain_sums = false;  // what rounding takes from the state is lost
  bool unchecked = false;   // no step fails, but where numbers end
  // Of an implicit Runge-Kutta method: many stages at once, or none where trajectories are.
  bool stages_in_lanes = false;
  bool trajectories_in_lanes = false;
  // H_0, H_1, ... of the modified Hamiltonian sum of h^j H_j whose values are wanted.
  std::vector<Expression> modified_terms = {};
};

// Of an implicit Runge-Kutta method for a kinetic energy that is a sum of squares of momenta: the
// stages of the momenta can be eliminated.
struct SecondOrder {
  bool unit_mobility = false;  // is d^2 H/dp_j^2 = 1 for all j?
  // Of what is written out, not of loops:
  Evaluation forces = {};                 // -dH/dq, n results
  Evaluation velocities = {};             // dH/dp
  std::vector<Expression> mobility = {};  // d^2 H/dp_j^2, of parameters alone
};

struct LoweredStep {
  SolvePlan plan;
  std::vector<Statement> coefficients;  // of h and parameters: once per run
  std::vector<Stage> stages;
  std::vector<Expression> increments;  // Z_i - z_i, 2n; zero where nothing changes
  // What is added to the increments without rounding, 2n, or none: then these are all of it.
  std::vector<Expression> rests = {};
  Evaluation energy;    // one result
  Evaluation gradient;  // 2n results
  Evaluation invariants;
  Evaluation events = {};  // the values whose zeros they are
  // The modified Hamiltonian, functions of h too: H + ... cut off after each of these powers of h.
  Evaluation modified_energies = {};
  std::vector<int> modified_powers = {};
  // Of a splitting: n results each, dV/dq and dT/dp.
  Evaluation potential_gradient = {};
  Evaluation kinetic_gradient = {};
  // Of a Runge-Kutta method: J grad H, 2n results.
  Evaluation vector_field = {};
  std::optional<StageLayout> stage_layout = {};  // of an implicit one
  std::optional<SecondOrder> second_order = {};
  // What stands around the instructions.
  Sequence sequence = {};
  bool tangent = false;     // is the tangent map wanted?
  bool plain_sums = false;  // what rounding takes from the state is lost
  bool unchecked = false;   // no step fails, but where numbers end
  // For that of a member that is solved.
  std::optional<Linearisation> linearisation = {};
  // Of an implicit Runge-Kutta method, and for the tangent maps of others: the entries of the
  // Hessian at `hessian_places`, i <= j.
  Evaluation hessian = {};
  std::vector<std::pair<int, int>> hessian_places = {};
};

// Values of free symbols, computed together: what they share is computed once.
[[nodiscard]] Evaluation evaluate_together(const std::vector<Expression>& values);
// Of H = p^2/2m + V(q), with numbers or parameters for 1/m.
[[nodiscard]] std::optional<SecondOrder> second_order_of(const Mechanics& mechanics);
[[nodiscard]] LoweredStep lower_step(const SolvePlan& plan, const StepWishes& wishes = {});
// With what the tangent map takes besides.
[[nodiscard]] LoweredStep with_tangent(LoweredStep lowered);
[[nodiscard]] Cost cost(const std::vector<Statement>& statements);
[[nodiscard]] std::string to_text(const Cost& cost);
// With two iterations where there are any; a function counts as 10, and so does a division.  Of
// splittings and Runge-Kutta methods those that are written out.
[[nodiscard]] long operations_per_step(const SolvePlan& plan);

}  // namespace hamgen
