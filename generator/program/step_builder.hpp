// The step's program while it is put together, block by block: what is defined where, which stage
// values and derivatives are known by which name now.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/program/lower.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// A block's solve before its expressions are lowered: handles of what it wants.
struct PendingSolve {
  Solve solve;
  int stage = 0;
  std::vector<std::size_t> cold, next, correction, residual;
  std::vector<std::vector<std::size_t>> matrix;
};

// A block solved by Newton's iteration, linear ones by its first step.
struct NewtonBlock {
  const Block& block;
  bool iterates = true;
  int where = 0;                    // the section its equations are evaluated in
  int outside = 0;                  // the section of what follows from its solution
  std::vector<int> members = {};    // the unknowns, and what has been torn out so far
  std::vector<int> evaluated = {};  // components of the gradient evaluated for it
  std::map<int, std::vector<Expression>> slopes = {};  // d(member)/d(unknown j)
  // Second derivatives of this block only, by their symbol: those of an earlier block are from
  // before its last increment, good enough to correct a gradient with, not to solve other equations
  // with.
  std::map<std::string, Expression> hessian = {};
  // matrix delta = -residual for the increments of the unknowns.
  std::vector<Expression> residual = {};
  std::vector<std::vector<Expression>> matrix = {};
  std::vector<Expression> increments = {};
};

class StepBuilder {
 public:
  explicit StepBuilder(const SolvePlan& plan);
  Program build();

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  // Where straight-line code goes to now.
  [[nodiscard]] int straight() const;
  // Opens a stage for the next solve.
  void open_solve();
  void define(const Expression& symbol, const Expression& value, int section);
  [[nodiscard]] const std::string& name_of(int i) const;

  // Note [rounding without bias]
  // What is small is summed first, and what rounding took from z comes with it: the step starts
  // from z + carry, of which z is the rounded value.  If a correction below half a unit of the last
  // place were added to a rounded gradient, or h dH/dp computed from a momentum p + h/2 dp on the
  // same grid of floating-point numbers as p, the error would depend on the step and not on chance:
  // a drift of the invariants that grows with the number of steps, not with its square root.
  [[nodiscard]] Expression carry_symbol(int i) const;
  // A small part of a sum, named so that it is computed first.
  Expression named_rest(const std::string& of, const Expression& value, int section);
  // Z_i - z_i - carry_i = +-h dH/dz_k, with the carry.
  Expression increment(int i, int k);

  // dH/dz_k at the stage values known now.
  void need_gradient(int k);
  // Stage symbols replaced by their present values.
  [[nodiscard]] Expression at_stage(const Expression& e) const;
  // zbar_i = z_i + h sum_k B_ik dH/dz_k with the gradient's present symbols.
  [[nodiscard]] Expression row(int i, int section);
  // h B_ik
  [[nodiscard]] Expression weight(int i, int k) const;
  // Gives a value a new symbol from here on.
  void renew(Expression& value, const std::string& name, const Expression& renewed, int section);

  void add_block(const Block& block);
  void add_assignment(int i);
  void add_quadratic(int i);
  void add_fixed_point(const Block& block);
  void add_sweeps();

  void add_newton(const Block& block);
  void add_simplified_newton(const Block& block);
  void evaluate_gradient(NewtonBlock& newton, int k);
  Expression second_derivative(NewtonBlock& newton, int k, int v);
  // sum_k h B_ik sum_v H_kv value(v) over the members v known so far.
  template <class Value>
  Expression chain(NewtonBlock& newton, int i, const Value& value);
  void tear_out(NewtonBlock& newton, int t);
  Expression name_slope(int t, int x, const Expression& value, int section);
  [[nodiscard]] Expression increment_symbol(int x) const;
  void solve_linear_system(NewtonBlock& newton, PendingSolve& pending);
  void write_out_solution(NewtonBlock& newton);
  void correct_solution(NewtonBlock& newton);
  void correct_gradient(int k, const Expression& change, int section);
  template <class Variables>
  [[nodiscard]] bool is_linear_in(int k, const Variables& variables) const;

  [[nodiscard]] Solve finished(PendingSolve& pending) const;

  const SolvePlan& plan_;
  const StepEquations& equations_;
  int n_;
  Lowering lowering_;
  std::vector<Expression> stage_value_;
  std::vector<Expression> gradient_;
  std::vector<bool> known_gradient_;
  // A gradient component as the last iteration evaluated it, and what its increment adds.
  std::vector<std::pair<Expression, Expression>> correction_;
  std::map<std::string, int> rests_;  // how many have been named, by what they belong to
  std::set<std::string> hessian_names_;
  std::vector<PendingSolve> solves_;
  int stage_ = 0;
  bool solving_done_ = false;
};

// Sections of the lowering: once per run, then three for each stage.
constexpr int kCoefficients = 0;
constexpr int before(int stage) { return 1 + 3 * stage; }
constexpr int body(int stage) { return 2 + 3 * stage; }
constexpr int after(int stage) { return 3 + 3 * stage; }

}  // namespace hamgen
