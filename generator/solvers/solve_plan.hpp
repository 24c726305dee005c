// What is solved how: the ordered blocks of the step's equations, and what was left out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/equations/step_equations.hpp"
#include "generator/solvers/all_solvers.hpp"
#include "generator/solvers/matrix_storage.hpp"

namespace hamgen {

enum class BlockKind {
  assign,     // the unknown is given by what is known before it
  linear,     // affine in its unknowns: one correction is exact
  quadratic,  // one unknown that enters as a quadratic: its root in closed form
  newton,
  fixed_point
};

// Unknowns solved together.  `torn` are given explicitly by the unknowns (in this order) and are
// eliminated: they cost no row of the linear system.
struct Block {
  BlockKind kind = BlockKind::assign;
  std::vector<int> unknowns = {};
  std::vector<int> torn = {};
  bool constant_matrix = false;  // the matrix depends on h and parameters only
  // Newton's matrix is approximate: the rows of the torn unknowns, too, are satisfied in the limit
  // only.
  bool simplified = false;
};

// How the linear systems are solved.
enum class LinearSolver { written_out, elimination, eigen_dense };

// The step of a system whose sums stay loops; alpha, beta, gamma are the same for all degrees of
// freedom.
enum class ArrayMethod {
  explicit_a,     // alpha = 0: q, then P, then Q
  explicit_b,     // alpha = 1
  gradient_only,  // a splitting or a Runge-Kutta method: no system to solve, or one without blocks
  newton,
  fixed_point,
  both,   // fixed point, and Newton where it contracts slowly
  sweeps  // SolvePlan::sweeps says how many
};
struct ArrayPlan {
  ArrayMethod method = ArrayMethod::newton;
  // Kinetic energy sum m_i p_i^2/2 + d_i p_i: the momenta are torn out, the unknowns are n.
  bool reduced = false;
  std::optional<Expression> mass = {};     // reduced: m_i, if they are all the same
  std::optional<ArrayMatrix> matrix = {};  // of Newton's iteration
  bool eigen = true;                       // may Eigen eliminate it?
  bool constant_matrix = false;            // factorised once per run
  // What Newton's matrix and its elimination cost, in evaluations of the equations: where the fixed
  // point would take more, Newton serves.
  int matrix_work = 0;
};

// How the stages of an implicit Runge-Kutta method are found.
enum class StageSolver {
  fixed_point,
  newton,  // simplified: one elimination of size 2 n s serves many iterations
  both     // fixed point, and Newton where it contracts slowly
};

struct SolvePlan {
  StepEquations equations;
  std::vector<Block> blocks = {};
  std::optional<int> sweeps = {};        // the paper's Algorithm 1 with this many corrector sweeps
  std::optional<ArrayPlan> arrays = {};  // set if the sums stay loops; then there are no blocks
  std::optional<StageSolver> stage_solver = {};  // of an implicit Runge-Kutta method
  bool ahead = false;                            // are derivatives of H evaluated a step ahead?
  std::string_view rule = kFixedPointRule;       // by which a fixed point ends that is alone
  std::string solver = {};  // one line for people: "Newton of size 1; p torn out"
  std::vector<std::string> left_out = {};
  [[nodiscard]] bool is_explicit() const;
};

// Who adds and multiplies: the processor, or for quad numbers, which Eigen does not know, a
// library.
enum class NumbersOf { processor, library };
// Throws UsageError for a solver that the step has not.
[[nodiscard]] SolvePlan plan_solve(const StepEquations& equations, const SolverChoice& solver,
                                   NumbersOf numbers = NumbersOf::processor);
[[nodiscard]] bool uses_eigen(const ArrayPlan& plan);
// Is there an iteration, with start values from earlier steps?
[[nodiscard]] bool iterates(const ArrayPlan& plan);
// Of sums that are loops: is tbar = t + h alpha no matter of an iteration?  Then Newton's matrix is
// without what the other equations have of it, and without the row of p_t, which no equation has:
// what couples to them couples to every element, and would make it wide.
[[nodiscard]] bool knows_time(const Mechanics& mechanics, const FamilyParameters& member);
// With the second derivatives that the matrix is made of.
[[nodiscard]] std::vector<Kernel> kernels_of_matrix(const Mechanics& mechanics,
                                                    const FamilyParameters& member);
// Of a splitting or a Runge-Kutta method.
[[nodiscard]] SolvePlan plan_without_member(const StepEquations& equations,
                                            const SolverChoice& solver);
[[nodiscard]] SolvePlan plan_arrays(const StepEquations& equations, const SolverWish& wish,
                                    NumbersOf numbers);
[[nodiscard]] LinearSolver linear_solver(const Block& block);
[[nodiscard]] std::string to_text(const SolvePlan& plan);
// What is said of SolvePlan::ahead.
inline constexpr std::string_view kAhead = "derivatives ahead";

}  // namespace hamgen
