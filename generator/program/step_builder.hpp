// The step's program while it is put together, block by block: what is defined where, which stage
// values and derivatives are known by which name now.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/mechanics/cancelling_forces.hpp"
#include "generator/program/linear_terms.hpp"
#include "generator/program/lower.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/program/rounded_terms.hpp"

namespace hamgen {

// A block's solve before its expressions are lowered: handles of what it wants.
struct PendingSolve {
  Solve solve;
  int stage = 0;
  std::vector<std::size_t> cold, beside, next, correction, residual, gradient;
  std::optional<std::size_t> refined_beside = {};
  std::vector<std::vector<std::size_t>> matrix;
};

// A block solved by Newton's iteration, linear ones by its first step.
struct NewtonBlock {
  const Block& block;
  bool iterates = true;             // else it is affine and written out
  int where = 0;                    // the section its equations are evaluated in
  int outside = 0;                  // the section of what follows from its solution
  std::vector<int> members = {};    // the unknowns, and what has been torn out so far
  std::vector<int> evaluated = {};  // components of the gradient evaluated for it
  std::map<int, std::vector<Expression>> slopes = {};  // d(member)/d(unknown j)
  // Of what is torn out: how far the row's solution is from it before the unknowns move.
  std::map<int, Expression> off = {};
  // Second derivatives of this block only, by their symbol: those of an earlier block are from
  // before its last increment, good enough to correct a gradient with, not to solve other equations
  // with.
  std::map<std::string, Expression> hessian = {};
  // matrix delta = -residual for the increments of the unknowns.
  std::vector<Expression> residual = {};
  std::vector<std::vector<Expression>> matrix = {};
  std::vector<Expression> increments = {};
  // matrix^-1 of an affine block.
  std::vector<std::vector<Expression>> inverse = {};
};

// With the unit slopes of its unknowns.
[[nodiscard]] NewtonBlock newton_block(const Block& block);

class StepBuilder {
 public:
  explicit StepBuilder(const SolvePlan& plan);
  LoweredStep build();

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  // Where straight-line code goes to now.
  [[nodiscard]] int straight() const;
  // Opens a stage for the next solve.
  void open_solve();
  void define(const Expression& symbol, const Expression& value, int section);
  [[nodiscard]] std::string name_of(int i) const;

  // Note [rounding without bias]
  // What is small is summed first, and what rounding took from z comes with it: the step starts
  // from z + carry, of which z is the rounded value.  If a correction below half a unit of the last
  // place were added to a rounded gradient, or h dH/dp computed from a momentum p + h/2 dp on the
  // same grid of floating-point numbers as p, the error would depend on the step and not on chance:
  // a drift of the invariants that grows with the number of steps, not with its square root.
  [[nodiscard]] Expression carry_symbol(int i) const;
  // A small part of a sum, named so that it is computed first.
  Expression named_rest(const std::string& of, const Expression& value, int section);
  // Note [affine blocks]
  // A constant matrix has the same rounding errors at every step, and so has what is solved with
  // it: a map that is not symplectic, and invariants that drift with the number of steps.  An
  // affine block is therefore solved twice with one inverse: the solution from z, and Newton's
  // correction by what its equations lack there.  Errors of the inverse enter times that
  // correction, itself no more than rounding.  The correction is as small at every step, too: added
  // to h dH/dp before that goes to z, it would fall below the last place time and again, so the two
  // are summed without an error.  Where the matrix is constant what the equations lack is itself
  // known far below rounding: with what h times a gradient loses, and what zbar - z does where
  // h omega is not small; else the form of the oscillator drifts by up to 5e-3 units of rounding a
  // step from h omega = 0.9 on.
  //
  // Z_i - z_i = +-h dH/dz_k with the carry, as a sum of what is large and what is small.
  RoundedTerm increment(int i, int k);

  // Note [weights that sum to one]
  // A step is symplectic if qbar_i - q_i is w and pbar_i - p_i is w - 1 times what q and p move by,
  // h dH/dp_i and h dH/dq_i, to the last digit.  Products with rounded weights will not do: where
  // h, w and constants of H are simple fractions, what rounding takes from w x is not chance but a
  // pattern of x, and differs from that of (1 - w) x and of x.  So h dH/dz is one number in both
  // rows and in the increment, its product with the larger weight comes with its error, and with
  // the smaller it is what is left, a difference without an error for weights from -1 to 2.
  // Weights that are exact, 1/2 and 1, need none of this.
  //
  // Note [rounded once]
  // Nothing is solved in an explicit step: its stage is z + (flow + carry).  Where flow is not
  // small beside z, a sum in the brackets that is rounded before it meets z falls half way between
  // two numbers too often, and h times the result is a product with a pattern: of the chain of 6
  // the form drifts by 1.2e-3 units of rounding a step at h = 0.7.  So z and flow are added first.
  //
  // Note [a rounded momentum is the momentum]
  // A momentum that is torn out is rounded on the grid of p, and where the matrix varies no row is
  // told what that lost.  The equations hold with the rounded one, and the step moves q by the same
  // product with it: what is rounded is a function of pbar, a part of dT/dp, and the step is that
  // of another H nearby.  Products with p and with its change, rounded apart, are no function of
  // pbar.  Where the equations had these, h/2 times each, every start drifted at a rate of its own,
  // of the soft chain of 2 at h = 1.3 by 4e-3 units of rounding a step, root mean square, and with
  // both in the step as well by 9e-3.
  //
  // Note [constants in two parts]
  // What a product with a constant loses is a pattern of its other factor where the constant is a
  // simple fraction, and that factor may have digits that end early: a sum of two numbers of
  // opposite signs is on their grid, not on its own.  Whether pbar is such a sum, of p and a force,
  // depends on which way the motion goes, and so does qbar after a long increment: the mean of the
  // pattern over those coarse numbers is a force or a velocity that knows the direction, and with
  // h omega from 1 on it drifts by up to 2e-3 units (soft chains in benchmarks/drift).  Of two
  // parts of the constant, of which neither is a simple fraction, the larger product is rounded
  // without a pattern and the smaller one loses nothing: one operation and a sum more.
  // Sums of other terms have all digits; so only products with sums of stage values are split, and
  // h times those, in steps whose forces have such terms at all.
  //
  // Note [the sum of the small parts]
  // A product that has been rounded, of both parts, is near the grid of simple fractions again, off
  // it by what its constant is.  A sum on a coarser grid loses that: a force that depends on how
  // large the other terms are, which is no gradient, and drifts (a ring of 4 by gauss-4 by 2.4e-4
  // units from one start).  So the larger products are added, and the sum of the smaller ones.
  //
  // The term of row i with dH/dz_k, and what rounding took from it.
  [[nodiscard]] RoundedTerm row_terms(int i, int k, const Expression& gradient, int section);
  // h times this, and what rounding took from it: where h is a simple fraction a pattern again.
  RoundedTerm flow_of(int k, const Expression& gradient, int section);
  // The product of this text, its error, and what is left without it.
  NameInTerm name_of_product(const std::string& text, int section);
  std::string short_name(const std::string& text, const std::string& place);
  // What rounding took from dH/dz_k itself.
  struct ConstantFactors {
    std::vector<std::pair<int, Expression>> factors;
    Expression at_zero;  // where the stage is
  };
  [[nodiscard]] std::optional<ConstantFactors> constant_factors(int k) const;
  Expression constant(const Expression& factor);
  Expression value_of_gradient(int k, int section);
  // See Note [constants in two parts].
  Parts constant_in_two_parts(const Expression& constant);
  [[nodiscard]] bool has_linear_force() const;
  Expression gradient_in_parts(int k, int section);
  // h in two parts where this gradient asks for them, else as it is.
  Parts step_size_for(int k);
  void find_lost_of_gradient(int k, int section);
  // Does dH/dz_k depend on the stage?
  [[nodiscard]] bool is_of_state(int k) const;
  [[nodiscard]] bool depends_on_state(const Expression& e) const;
  // A number of its own, defined once by this name.
  Expression name_once(const std::string& name, const Expression& value, int section,
                       Lowering::Keep keep = Lowering::Keep::yes);
  // dH/dz_k at the stage values known now, in this section.
  void define_gradient(int k, int section);
  // dH/dz_k at the stage values known now.
  void need_gradient(int k);
  // Stage symbols replaced by their present values.
  [[nodiscard]] Expression at_stage(const Expression& e) const;
  // zbar_i = z_i + h sum_k B_ik dH/dz_k with the gradient's present symbols.
  [[nodiscard]] Expression row(int i, int section);
  // A stage value less its row.
  [[nodiscard]] Expression lacking(int i, const Expression& value, int section);
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
  // 1 - d(row t)/d(zbar_t)
  [[nodiscard]] Expression own_slope(int t) const;
  void tear_value(NewtonBlock& newton, int t);
  void tear_slopes(NewtonBlock& newton, int t);
  Expression name_slope(int t, int x, const Expression& value, int section);
  [[nodiscard]] Expression increment_symbol(int x) const;
  void solve_linear_system(NewtonBlock& newton, PendingSolve& pending);
  void add_matrix_row(NewtonBlock& newton, int x);
  // "R(q" of row i.
  [[nodiscard]] std::string residual_name(const Block& block, std::size_t i) const;
  Expression name_value(const std::string& text, const Expression& value, int section);
  void name_matrix(NewtonBlock& newton, std::size_t i);
  void write_out_solution(NewtonBlock& newton);
  void add_affine(const Block& block);
  void write_out_inverse(NewtonBlock& newton);
  void start_affine(NewtonBlock& newton);
  void find_off(NewtonBlock& newton);
  Expression lack_of(NewtonBlock& newton, int i);
  void multiply_out(NewtonBlock& newton, const std::vector<Expression>& lack);
  void correct_solution(NewtonBlock& newton);
  void correct_gradient(int k, const Expression& change, int section);

  void find_rounded_beside();
  // Where the unknown x begins, and what it is rounded with.
  void begin_with_state(PendingSolve& pending, int x);
  [[nodiscard]] Solve finished(PendingSolve& pending) const;

  const SolvePlan& plan_;
  const StepEquations& equations_;
  int n_;
  LinearTerms linear_terms_;  // in the stage values
  Lowering lowering_;
  std::vector<Expression> stage_value_;
  std::vector<Expression> gradient_;
  std::vector<bool> known_gradient_;
  // A gradient component as the last iteration evaluated it, and what its increment adds.
  std::vector<std::pair<Expression, Expression>> correction_;
  std::map<std::string, Expression> lost_of_gradient_;  // by its name
  std::map<int, Expression> change_of_gradient_;        // of a fixed point that is solved
  std::map<std::string, std::string> short_names_;      // of products, by their texts
  std::map<std::string, int> rests_;  // how many have been named, by what they belong to
  std::set<std::string> hessian_names_;
  std::vector<PendingSolve> solves_;
  std::vector<Expression> rounded_beside_;  // see Note [forces that cancel]
  int stage_ = 0;
  bool solving_done_ = false;
  std::set<std::string> solved_;   // stage values of the blocks so far
  bool solves_constants_ = false;  // see Note [affine blocks]
  bool keeps_losses_ = false;      // and what rounding takes from h times them
  bool is_explicit_ = false;       // is nothing solved?
  bool sums_exactly_ = false;      // increments and their rests, see Note [affine blocks]
  bool keeps_gradients_ = false;   // each as a number, see Note [weights that sum to one]
  bool splits_products_ = false;   // see Note [constants in two parts]
  std::set<std::string> named_;
};

template <class Value>
Expression StepBuilder::chain(NewtonBlock& newton, int i, const Value& value) {
  std::vector<Expression> terms;
  for (const int k : equations_.row_gradients(i)) {
    for (const int v : newton.members) {
      const Expression factor = value(v);
      if (factor.is_zero()) continue;
      terms.push_back(weight(i, k) * second_derivative(newton, k, v) * factor);
    }
  }
  return Expression::sum(std::move(terms));
}

// Sections of the lowering: once per run, then three for each stage.
constexpr int kCoefficients = 0;
constexpr int before(int stage) { return 1 + 3 * stage; }
constexpr int body(int stage) { return 2 + 3 * stage; }
constexpr int after(int stage) { return 3 + 3 * stage; }

}  // namespace hamgen
