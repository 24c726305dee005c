#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/program/lower.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

namespace {

constexpr int kCoefficients = 0;
constexpr int before(int stage) { return 1 + 3 * stage; }
constexpr int body(int stage) { return 2 + 3 * stage; }
constexpr int after(int stage) { return 3 + 3 * stage; }

// A block's solve while the program is being put together.
struct PendingSolve {
  Solve solve;
  int stage = 0;
  std::vector<std::size_t> cold, next, correction, residual;
  std::vector<std::vector<std::size_t>> matrix;
};

class Builder {
 public:
  explicit Builder(const SolvePlan& plan)
      : plan_(plan),
        equations_(plan.equations),
        n_(plan.equations.mechanics.degrees_of_freedom),
        lowering_(sections(plan)) {
    for (const Quantity& parameter : equations_.mechanics.parameters) {
      lowering_.declare(parameter.name, kCoefficients);
    }
    lowering_.declare("h", kCoefficients);
    lowering_.declare("E0", kCoefficients);
    for (int i = 0; i < 2 * n_; ++i) {
      lowering_.declare(equations_.mechanics.variables[index(i)].name, before(0));
      lowering_.declare("carry(" + name_of(i) + ")", before(0));
      stage_value_.push_back(equations_.stage(i));
      gradient_.push_back(equations_.gradient_symbol(i));
    }
    known_gradient_.resize(index(2 * n_), false);
    correction_.resize(index(2 * n_));
  }

  Program build() {
    if (plan_.sweeps) {
      add_sweeps();
    } else {
      for (const Block& block : plan_.blocks) add_block(block);
    }
    std::vector<std::size_t> increments;
    for (int i = 0; i < 2 * n_; ++i) {
      const int k = i < n_ ? i + n_ : i - n_;
      need_gradient(k);
      increments.push_back(lowering_.want(increment(i, k), straight()));
    }
    lowering_.run();

    Program program{.plan = plan_};
    program.coefficients = lowering_.statements(kCoefficients);
    for (int s = 0; s <= stage_; ++s) {
      Stage stage{.before = lowering_.statements(before(s)),
                  .after = lowering_.statements(after(s))};
      for (PendingSolve& pending : solves_) {
        if (pending.stage == s) stage.solve = finished(pending);
      }
      program.stages.push_back(std::move(stage));
    }
    for (const std::size_t handle : increments) {
      program.increments.push_back(lowering_.wanted(handle));
    }
    return program;
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  static std::vector<Section> sections(const SolvePlan& plan) {
    std::vector<Section> result(4 + 3 * plan.blocks.size() + 3);
    for (std::size_t s = 0; 2 + 3 * s < result.size(); ++s) result[2 + 3 * s].is_loop = true;
    return result;
  }

  // The section straight-line code goes to now.
  [[nodiscard]] int straight() const { return solving_done_ ? after(stage_) : before(stage_); }

  // Opens a stage for the next solve.
  void open_solve() {
    if (solving_done_) ++stage_;
    solving_done_ = true;
  }

  // Note [rounding without bias]
  // What is small is summed first, and what rounding took from z comes with it: the step starts
  // from z + carry, of which z is the rounded value.  If a correction below half a unit of the last
  // place were added to a rounded gradient, or h dH/dp computed from a momentum p + h/2 dp on the
  // same grid of floating-point numbers as p, the error would depend on the step and not on chance:
  // a drift of the invariants that grows with the number of steps, not with its square root.
  Expression carry_symbol(int i) const {
    // What never changes is never rounded.
    if (gradient_[index(i < n_ ? i + n_ : i - n_)].is_zero()) return Expression(0);
    return Expression::symbol("carry(" + name_of(i) + ")", kRankOfTemporary);
  }
  [[nodiscard]] const std::string& name_of(int i) const {
    return equations_.mechanics.variables[index(i)].name;
  }

  // Z_i - z_i - carry_i = +-h dH/dz_k, with the carry.
  Expression increment(int i, int k) {
    if (gradient_[index(k)].is_zero()) return gradient_[index(k)];
    const Expression h = i < n_ ? step_size() : -step_size();
    const auto& [main, correction] = correction_[index(k)];
    if (correction.is_zero()) return h * gradient_[index(k)] + carry_symbol(i);
    return h * main + named_rest("d" + name_of(i), carry_symbol(i) + h * correction, straight());
  }

  // A small part of a sum, named so that it is computed first.
  Expression named_rest(const std::string& of, const Expression& value, int section) {
    const int before = rests_[of]++;
    const Expression symbol = Expression::symbol(
        fmt::format("rest({}){}", of, std::string(index(before), '*')), kRankOfTemporary);
    define(symbol, value, section);
    return symbol;
  }

  // dH/dz_k at the stage values known now.
  void need_gradient(int k) {
    if (known_gradient_[index(k)] || gradient_[index(k)].is_zero()) return;
    known_gradient_[index(k)] = true;
    lowering_.define(gradient_[index(k)].name(), at_stage(equations_.stage_gradient(k)),
                     straight());
  }

  // Stage symbols replaced by their present values.
  [[nodiscard]] Expression at_stage(const Expression& e) const {
    Substitution replacements;
    for (int i = 0; i < 2 * n_; ++i) {
      if (stage_value_[index(i)] != equations_.stage(i)) {
        replacements.emplace(equations_.stage(i).name(), stage_value_[index(i)]);
      }
    }
    return replacements.empty() ? e : substitute(e, replacements);
  }

  // Row i with the gradient's present symbols.
  [[nodiscard]] Expression row(int i, int section) {
    std::vector<Expression> terms{carry_symbol(i)};
    for (const int k : equations_.row_gradients(i)) {
      terms.push_back(weight(i, k) * gradient_[index(k)]);
    }
    return equations_.mechanics.variable(i) +
           named_rest(name_of(i), Expression::sum(std::move(terms)), section);
  }

  [[nodiscard]] Expression weight(int i, int k) const {
    return step_size() * equations_.stage_matrix.at({i, k});
  }

  void define(const Expression& symbol, const Expression& value, int section) {
    lowering_.define(symbol.name(), value, section);
  }

  void add_block(const Block& block) {
    switch (block.kind) {
      case BlockKind::assign:
        add_assignment(block.unknowns[0]);
        return;
      case BlockKind::quadratic:
        add_quadratic(block.unknowns[0]);
        return;
      case BlockKind::linear:
      case BlockKind::newton:
        if (block.simplified) {
          add_simplified_newton(block);
        } else {
          add_newton(block);
        }
        return;
      case BlockKind::fixed_point:
        add_fixed_point(block);
        return;
    }
  }

  void add_assignment(int i) {
    for (const int k : equations_.row_gradients(i)) need_gradient(k);
    define(stage_value_[index(i)], row(i, straight()), straight());
  }

  // c0 + c1 d + c2 d^2 = 0 for d = zbar_i - z_i: the root that tends to 0 with h, in the form
  // without cancellation, d = -2 c0 / (c1 + sqrt(c1^2 - 4 c0 c2)).
  void add_quadratic(int i) {
    const Expression z = equations_.mechanics.variable(i);
    const std::string bar = equations_.stage(i).name();
    Expression c0(0);
    Expression c1(1);
    Expression c2(0);
    for (const int k : equations_.row_gradients(i)) {
      const Expression slope = at_stage(equations_.stage_hessian(k, i));
      auto slope_at = [&](const Expression& x) { return substitute(slope, {{bar, x}}); };
      const Expression w = weight(i, k);
      c0 += -(w * substitute(at_stage(equations_.stage_gradient(k)), {{bar, z}}));
      c1 += -(w * slope_at(z));
      c2 += -(w * Expression(Rational(1, 2)) * (slope_at(Expression(1)) - slope_at(Expression(0))));
    }
    const std::string& name = equations_.mechanics.variables[index(i)].name;
    auto named = [&](const std::string& what, const Expression& value) {
      const Expression symbol = Expression::symbol(what + "(" + name + ")", kRankOfTemporary + i);
      define(symbol, value, straight());
      return symbol;
    };
    const Expression constant = named("c0", c0);
    const Expression linear = named("c1", c1);
    const Expression square = named("c2", c2);
    const Expression root = square_root(linear * linear - Expression(4) * constant * square);
    const Expression d = Expression(-2) * constant / (linear + root);
    define(stage_value_[index(i)], z + d, straight());
  }

  // Second derivatives of one block only: those of an earlier block are from before its last
  // increment, good enough to correct a gradient with, not to solve other equations with.
  using BlockHessian = std::map<std::string, Expression>;

  Expression second_derivative(BlockHessian& known, int k, int j, int section) {
    const Expression plain = equations_.hessian_symbol(k, j);
    if (plain.is_zero()) return plain;
    if (const auto it = known.find(plain.name()); it != known.end()) return it->second;
    std::string name = plain.name();
    while (!hessian_names_.insert(name).second) name += "*";
    const Expression symbol = Expression::symbol(name, plain.rank());
    define(symbol, at_stage(equations_.stage_hessian(k, j)), section);
    known.emplace(plain.name(), symbol);
    return symbol;
  }

  // Newton's iteration on the unknowns, with the torn variables eliminated by the chain rule.  The
  // last increment also corrects the gradient to first order, so that no evaluation at the solution
  // is needed: the error is quadratic in that increment, as Newton's own.
  void add_newton(const Block& block) {
    const bool linear = block.kind == BlockKind::linear;
    PendingSolve pending;
    Solve& solve = pending.solve;
    const std::size_t m = block.unknowns.size();
    solve.kind = block.kind;
    solve.linear_solver = linear_solver(block);
    solve.constant_matrix = linear && block.constant_matrix;
    const bool written_out = solve.linear_solver == LinearSolver::written_out;
    const bool loop = !linear;
    if (!linear || !written_out) open_solve();
    pending.stage = stage_;
    const int where = loop ? body(stage_) : (written_out ? straight() : before(stage_));
    const int outside = loop || !written_out ? after(stage_) : straight();

    for (const int x : block.unknowns) {
      if (loop) {
        lowering_.declare(stage_value_[index(x)].name(), where);
      } else {
        // An affine system may start anywhere.  From 0 the increment is the solution itself, and
        // nothing cancels for large h; from z it would lose (h omega)^2 units of rounding.
        stage_value_[index(x)] = Expression(0);
      }
    }
    std::vector<int> members = block.unknowns;
    // d(torn)/d(unknown), and the gradient components evaluated in the loop.
    std::map<int, std::vector<Expression>> slopes;
    for (std::size_t j = 0; j < m; ++j) {
      std::vector<Expression> unit(m, Expression(0));
      unit[j] = Expression(1);
      slopes[block.unknowns[j]] = unit;
    }
    std::vector<int> evaluated;
    auto evaluate = [&](int k) {
      if (known_gradient_[index(k)]) return;
      known_gradient_[index(k)] = true;
      evaluated.push_back(k);
      define(gradient_[index(k)], at_stage(equations_.stage_gradient(k)), where);
    };
    BlockHessian known_hessian;
    auto hessian = [&](int k, int j) { return second_derivative(known_hessian, k, j, where); };
    // sum_k h B_ik sum_v H_kv dv/dx_j over the members v known so far, without `except`.
    auto chain = [&](int i, std::size_t j, int except) {
      std::vector<Expression> terms;
      for (const int k : equations_.row_gradients(i)) {
        for (const int v : members) {
          if (v == except || slopes.at(v)[j].is_zero()) continue;
          if (!equations_.mechanics.hessian.contains(std::minmax(k, v))) continue;
          terms.push_back(weight(i, k) * hessian(k, v) * slopes.at(v)[j]);
        }
      }
      return Expression::sum(std::move(terms));
    };
    for (const int t : block.torn) {
      Expression denominator(1);
      if (equations_.depends(t, t)) {
        // Affine in itself: solved for.
        const Substitution zero{{equations_.stage(t).name(), Expression(0)}};
        std::vector<Expression> terms{carry_symbol(t)};
        for (const int k : equations_.row_gradients(t)) {
          terms.push_back(weight(t, k) * at_stage(substitute(equations_.stage_gradient(k), zero)));
          denominator += -(weight(t, k) * at_stage(equations_.stage_hessian(k, t)));
        }
        const Expression known = equations_.mechanics.variable(t) +
                                 named_rest(name_of(t), Expression::sum(std::move(terms)), where);
        define(stage_value_[index(t)], known / denominator, where);
      } else {
        for (const int k : equations_.row_gradients(t)) evaluate(k);
        define(stage_value_[index(t)], row(t, where), where);
      }
      std::vector<Expression> slope(m);
      for (std::size_t j = 0; j < m; ++j) {
        const Expression value = chain(t, j, t) / denominator;
        slope[j] = name_slope(t, block.unknowns[j], value, where);
      }
      for (const int k : equations_.row_gradients(t)) evaluate(k);
      slopes[t] = std::move(slope);
      members.push_back(t);
    }
    for (const int x : block.unknowns) {
      for (const int k : equations_.row_gradients(x)) evaluate(k);
    }
    std::vector<Expression> residual;
    std::vector<std::vector<Expression>> matrix(m, std::vector<Expression>(m));
    for (std::size_t i = 0; i < m; ++i) {
      const int x = block.unknowns[i];
      residual.push_back(stage_value_[index(x)] - row(x, where));
      for (std::size_t j = 0; j < m; ++j) {
        matrix[i][j] = Expression(i == j ? 1 : 0) - chain(x, j, -1);
      }
    }
    std::vector<Expression> corrections;
    for (const int x : block.unknowns) corrections.push_back(correction_symbol(x));
    if (written_out) {
      write_out(block, residual, matrix, corrections, where);
    } else {
      for (const Expression& e : residual) pending.residual.push_back(lowering_.want(e, where));
      const int matrix_section = solve.constant_matrix ? kCoefficients : where;
      for (const auto& line : matrix) {
        auto& handles = pending.matrix.emplace_back();
        for (const Expression& e : line) handles.push_back(lowering_.want(e, matrix_section));
      }
      for (const Expression& symbol : corrections) {
        solve.corrections.push_back(symbol.name());
        lowering_.declare(symbol.name(), loop ? where : after(stage_));
      }
    }
    for (std::size_t j = 0; j < m; ++j) {
      const int x = block.unknowns[j];
      solve.variables.push_back({stage_value_[index(x)].name(), {}, {}, {}});
      if (!loop) solve.variables.back().name = correction_symbol(x).name();
      pending.cold.push_back(lowering_.want(equations_.mechanics.variable(x), before(stage_)));
      if (written_out && loop) pending.correction.push_back(lowering_.want(corrections[j], where));
    }
    if (loop || !written_out) solves_.push_back(std::move(pending));

    // Everything that was evaluated before the last increment, corrected by it.
    std::map<int, Expression> moved;
    for (const int v : members) {
      std::vector<Expression> terms;
      for (std::size_t j = 0; j < m; ++j) terms.push_back(slopes.at(v)[j] * corrections[j]);
      moved[v] = Expression::sum(std::move(terms));
    }
    // Torn variables whose rows need corrected gradients only are computed anew from these, and so
    // is what depends on nothing else but linearly: the kinetic part of a separable H.
    std::set<int> anew;
    for (const int t : block.torn) {
      const auto corrected = [&](int k) {
        return std::ranges::find(evaluated, k) != evaluated.end() && !is_linear_in(k, block.torn);
      };
      if (loop && !equations_.depends(t, t) &&
          std::ranges::all_of(equations_.row_gradients(t), corrected)) {
        anew.insert(t);
      }
    }
    const auto is_anew = [&](int k) { return loop && is_linear_in(k, anew); };
    for (const int k : evaluated) {
      if (is_anew(k)) continue;
      std::vector<Expression> terms;
      for (const int v : members) {
        if (equations_.mechanics.hessian.contains(std::minmax(k, v))) {
          terms.push_back(hessian(k, v) * moved[v]);
        }
      }
      correct_gradient(k, Expression::sum(std::move(terms)), outside);
    }
    for (const int v : members) {
      const Expression value =
          anew.contains(v) ? row(v, outside) : stage_value_[index(v)] + moved[v];
      renew(stage_value_[index(v)], equations_.stage(v).name(), value, outside);
    }
    for (const int k : evaluated) {
      if (!is_anew(k)) continue;
      renew(gradient_[index(k)], gradient_[index(k)].name(), at_stage(equations_.stage_gradient(k)),
            outside);
    }
  }

  // Newton's iteration with the Hessian of a shorter K.  The torn unknowns are eliminated from the
  // linear system only: delta_t = r_t + sum_j slope_tj delta_j, where r_t is what their rows lack
  // now.  The last increment corrects the gradient with the same Hessian, whose error times that
  // increment is as small as the next increment, which the stopping rule bounds.
  void add_simplified_newton(const Block& block) {
    open_solve();
    PendingSolve pending{.solve = {}, .stage = stage_};
    Solve& solve = pending.solve;
    solve.kind = BlockKind::newton;
    solve.simplified = true;
    solve.linear_solver = linear_solver(block);
    const int where = body(stage_);
    const std::size_t m = block.unknowns.size();
    std::vector<int> members = block.unknowns;
    members.insert(members.end(), block.torn.begin(), block.torn.end());
    for (const int v : members) lowering_.declare(stage_value_[index(v)].name(), where);
    std::vector<int> evaluated;
    for (const int v : members) {
      for (const int k : equations_.row_gradients(v)) {
        if (known_gradient_[index(k)]) continue;
        known_gradient_[index(k)] = true;
        evaluated.push_back(k);
        define(gradient_[index(k)], at_stage(equations_.stage_gradient(k)), where);
      }
    }
    BlockHessian known_hessian;
    auto hessian = [&](int k, int v) { return second_derivative(known_hessian, k, v, where); };
    // delta_v = lacking.at(v) + sum_j slopes.at(v)[j] delta_j of the members known so far.
    std::map<int, Expression> lacking;
    std::map<int, std::vector<Expression>> slopes;
    for (std::size_t j = 0; j < m; ++j) {
      slopes[block.unknowns[j]].resize(m);
      slopes[block.unknowns[j]][j] = Expression(1);
    }
    // sum_k h B_ik sum_v H_kv what(v)
    auto chain = [&](int i, auto&& what) {
      std::vector<Expression> terms;
      for (const int k : equations_.row_gradients(i)) {
        for (const auto& [v, slope] : slopes) {
          const Expression value = what(v);
          if (!value.is_zero()) terms.push_back(weight(i, k) * hessian(k, v) * value);
        }
      }
      return Expression::sum(std::move(terms));
    };
    auto residual = [&](int i) {
      return stage_value_[index(i)] - row(i, where) - chain(i, [&](int v) { return lacking[v]; });
    };
    for (const int t : block.torn) {
      const Expression symbol = Expression::symbol(
          "R(" + equations_.mechanics.variables[index(t)].name + ")", kRankOfTemporary + t);
      define(symbol, residual(t), where);
      std::vector<Expression> slope;
      for (std::size_t j = 0; j < m; ++j) {
        slope.push_back(name_slope(t, block.unknowns[j],
                                   chain(t, [&](int v) { return slopes.at(v)[j]; }), where));
      }
      lacking[t] = -symbol;
      slopes[t] = std::move(slope);
    }
    std::vector<Expression> lacks;
    std::vector<std::vector<Expression>> matrix(m, std::vector<Expression>(m));
    for (std::size_t i = 0; i < m; ++i) {
      lacks.push_back(residual(block.unknowns[i]));
      for (std::size_t j = 0; j < m; ++j) {
        matrix[i][j] = Expression(i == j ? 1 : 0) -
                       chain(block.unknowns[i], [&](int v) { return slopes.at(v)[j]; });
      }
    }
    std::map<int, Expression> corrections;
    std::vector<Expression> unknown_corrections;
    for (const int x : block.unknowns) {
      corrections[x] = correction_symbol(x);
      unknown_corrections.push_back(corrections[x]);
    }
    if (solve.linear_solver == LinearSolver::written_out) {
      write_out(block, lacks, matrix, unknown_corrections, where);
    } else {
      for (const Expression& e : lacks) pending.residual.push_back(lowering_.want(e, where));
      for (const auto& line : matrix) {
        auto& handles = pending.matrix.emplace_back();
        for (const Expression& e : line) handles.push_back(lowering_.want(e, where));
      }
      for (const Expression& symbol : unknown_corrections) {
        solve.corrections.push_back(symbol.name());
        lowering_.declare(symbol.name(), where);
      }
    }
    for (const int t : block.torn) {
      std::vector<Expression> terms{lacking[t]};
      for (std::size_t j = 0; j < m; ++j) terms.push_back(slopes.at(t)[j] * unknown_corrections[j]);
      corrections[t] = correction_symbol(t);
      define(corrections[t], Expression::sum(std::move(terms)), where);
    }
    for (const int v : members) {
      solve.variables.push_back({stage_value_[index(v)].name(), {}, {}, {}});
      pending.cold.push_back(lowering_.want(equations_.mechanics.variable(v), before(stage_)));
      if (solve.corrections.empty())
        pending.correction.push_back(lowering_.want(corrections[v], where));
    }
    solves_.push_back(std::move(pending));

    const int outside = after(stage_);
    for (const int k : evaluated) {
      std::vector<Expression> terms;
      for (const int v : members) terms.push_back(hessian(k, v) * corrections[v]);
      correct_gradient(k, Expression::sum(std::move(terms)), outside);
    }
    for (const int v : members) {
      renew(stage_value_[index(v)], equations_.stage(v).name(),
            stage_value_[index(v)] + corrections[v], outside);
    }
  }

  // dH/dz_k as the last iteration evaluated it, and what the last increment adds.
  void correct_gradient(int k, const Expression& change, int section) {
    if (change.is_zero()) return;
    const Expression main = gradient_[index(k)];
    const Expression symbol = Expression::symbol("change(" + main.name() + ")", kRankOfTemporary);
    define(symbol, change, section);
    correction_[index(k)] = {main, symbol};
    renew(gradient_[index(k)], main.name(), main + symbol, section);
  }

  // Is dH/dz_k linear with constant coefficients in some of these variables and free of all others?
  template <class Variables>
  [[nodiscard]] bool is_linear_in(int k, const Variables& variables) const {
    bool any = false;
    for (int v = 0; v < 2 * n_; ++v) {
      const auto entry = equations_.mechanics.hessian.find(std::minmax(k, v));
      if (entry == equations_.mechanics.hessian.end()) continue;
      if (std::ranges::find(variables, v) == std::ranges::end(variables)) return false;
      std::set<std::string> used;
      collect_symbols(entry->second, used);
      for (const Quantity& variable : equations_.mechanics.variables) {
        if (used.contains(variable.name)) return false;
      }
      any = true;
    }
    return any;
  }

  // d(t)/d(x): named, because it is used for every row.
  Expression name_slope(int t, int x, const Expression& value, int section) {
    if (value.is_number()) return value;
    const auto& variables = equations_.mechanics.variables;
    const Expression symbol = Expression::symbol(
        "d(" + variables[index(t)].name + ")/d(" + variables[index(x)].name + ")",
        kRankOfTemporary);
    define(symbol, value, section);
    return symbol;
  }

  Expression correction_symbol(int x) const {
    return Expression::symbol("delta(" + equations_.mechanics.variables[index(x)].name + ")",
                              kRankOfTemporary);
  }

  // -matrix^-1 residual by Cramer's rule, with the inverse named when it is constant.
  void write_out(const Block& block, const std::vector<Expression>& residual,
                 const std::vector<std::vector<Expression>>& matrix,
                 const std::vector<Expression>& corrections, int section) {
    const std::size_t m = residual.size();
    auto name = [&](const std::string& what, std::size_t i) {
      return what + "(" + equations_.mechanics.variables[index(block.unknowns[i])].name;
    };
    auto named = [&](const std::string& text, const Expression& value) {
      if (value.is_number()) return value;
      const Expression symbol = Expression::symbol(text, kRankOfTemporary);
      define(symbol, value, section);
      return symbol;
    };
    std::vector<Expression> r;
    std::vector<std::vector<Expression>> a(m, std::vector<Expression>(m));
    for (std::size_t i = 0; i < m; ++i) {
      r.push_back(named(name("R", i) + ")", residual[i]));
      for (std::size_t j = 0; j < m; ++j) {
        const std::string column = equations_.mechanics.variables[index(block.unknowns[j])].name;
        a[i][j] = named(name("R", i) + "," + column + ")", matrix[i][j]);
      }
    }
    if (m == 1) {
      // A constant slope is inverted once per run.
      define(corrections[0], -(r[0] * Expression::power(a[0][0], Expression(-1))), section);
      return;
    }
    auto minor = [&](std::size_t i, std::size_t j) -> Expression {
      if (m == 2) return a[1 - i][1 - j];
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      return a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
    };
    // Cofactors of a 3 x 3 matrix with cyclic indices carry their sign; those of a 2 x 2 do not.
    auto cofactor = [&](std::size_t i, std::size_t j) {
      return m == 2 && i != j ? -minor(i, j) : minor(i, j);
    };
    Expression determinant(0);
    for (std::size_t j = 0; j < m; ++j) determinant += a[0][j] * cofactor(0, j);
    const Expression inverse =
        named(name("1/det", 0) + ")", Expression::power(determinant, Expression(-1)));
    for (std::size_t j = 0; j < m; ++j) {
      std::vector<Expression> terms;
      for (std::size_t i = 0; i < m; ++i) terms.push_back(cofactor(i, j) * r[i]);
      define(corrections[j], -(inverse * Expression::sum(std::move(terms))), section);
    }
  }

  // Gives a value a new symbol from here on.
  void renew(Expression& value, const std::string& name, const Expression& renewed, int section) {
    if (renewed == value) return;
    const Expression symbol = Expression::symbol(name + "*", kRankOfTemporary);
    define(symbol, renewed, section);
    value = symbol;
  }

  void add_fixed_point(const Block& block) {
    open_solve();
    PendingSolve pending{.stage = stage_};
    pending.solve.kind = BlockKind::fixed_point;
    const int where = body(stage_);
    for (const int x : block.unknowns) lowering_.declare(stage_value_[index(x)].name(), where);
    auto evaluate = [&](int k) {
      if (known_gradient_[index(k)]) return;
      known_gradient_[index(k)] = true;
      define(gradient_[index(k)], at_stage(equations_.stage_gradient(k)), where);
    };
    for (const int t : block.torn) {
      for (const int k : equations_.row_gradients(t)) evaluate(k);
      define(stage_value_[index(t)], row(t, where), where);
    }
    for (const int x : block.unknowns) {
      for (const int k : equations_.row_gradients(x)) evaluate(k);
      pending.solve.variables.push_back({stage_value_[index(x)].name(), {}, {}, {}});
      pending.cold.push_back(lowering_.want(equations_.mechanics.variable(x), before(stage_)));
      pending.next.push_back(lowering_.want(row(x, where), where));
    }
    solves_.push_back(std::move(pending));
  }

  // Algorithm 1 of the paper: predictor z + h J grad H(z), then K times zbar from the last Z and
  // Z = z + h J grad H(zbar).  In terms of the gradient g: g = grad H(z), K times g = grad
  // H(zbar(g)).
  void add_sweeps() {
    open_solve();
    PendingSolve pending{.stage = stage_};
    pending.solve.kind = BlockKind::fixed_point;
    pending.solve.sweeps = plan_.sweeps;
    const int where = body(stage_);
    for (int k = 0; k < 2 * n_; ++k) {
      if (!gradient_[index(k)].is_zero()) lowering_.declare(gradient_[index(k)].name(), where);
      known_gradient_[index(k)] = true;
    }
    for (int i = 0; i < 2 * n_; ++i) define(equations_.stage(i), row(i, where), where);
    for (int k = 0; k < 2 * n_; ++k) {
      if (gradient_[index(k)].is_zero()) continue;
      pending.solve.variables.push_back({gradient_[index(k)].name(), {}, {}, {}});
      pending.cold.push_back(
          lowering_.want(equations_.mechanics.gradient[index(k)], before(stage_)));
      pending.next.push_back(lowering_.want(equations_.stage_gradient(k), where));
    }
    // After the loop the gradient is a value of its own: what the loop made of the one before it
    // does not hold for it.
    for (Expression& component : gradient_) {
      if (component.is_zero()) continue;
      component = Expression::symbol(component.name() + "*", kRankOfTemporary);
      lowering_.declare(component.name(), after(stage_));
    }
    solves_.push_back(std::move(pending));
  }

  Solve finished(PendingSolve& pending) const {
    Solve solve = std::move(pending.solve);
    solve.body = lowering_.statements(body(pending.stage));
    for (std::size_t j = 0; j < solve.variables.size(); ++j) {
      LoopVariable& variable = solve.variables[j];
      if (j < pending.cold.size()) variable.cold = lowering_.wanted(pending.cold[j]);
      if (j < pending.next.size()) variable.next = lowering_.wanted(pending.next[j]);
      if (j < pending.correction.size()) {
        variable.correction = lowering_.wanted(pending.correction[j]);
      }
    }
    for (const std::size_t handle : pending.residual) {
      solve.residual.push_back(lowering_.wanted(handle));
    }
    for (const auto& line : pending.matrix) {
      auto& row = solve.matrix.emplace_back();
      for (const std::size_t handle : line) row.push_back(lowering_.wanted(handle));
    }
    return solve;
  }

  const SolvePlan& plan_;
  const StepEquations& equations_;
  int n_;
  Lowering lowering_;
  std::vector<Expression> stage_value_;
  std::vector<Expression> gradient_;
  // A gradient component as the last iteration evaluated it, and what its increment adds.
  std::vector<std::pair<Expression, Expression>> correction_;
  std::map<std::string, int> rests_;  // how many have been named, by what they belong to
  std::vector<bool> known_gradient_;
  std::set<std::string> hessian_names_;
  std::vector<PendingSolve> solves_;
  int stage_ = 0;
  bool solving_done_ = false;
};

}  // namespace

Evaluation evaluate_together(const std::vector<Expression>& values) {
  Lowering lowering({Section{}});
  std::set<std::string> free;
  for (const Expression& value : values) collect_symbols(value, free);
  for (const std::string& symbol : free) lowering.declare(symbol, 0);
  std::vector<std::size_t> handles;
  for (const Expression& value : values) handles.push_back(lowering.want(value, 0));
  lowering.run();
  Evaluation evaluation{.statements = lowering.statements(0)};
  for (const std::size_t handle : handles) evaluation.results.push_back(lowering.wanted(handle));
  return evaluation;
}

namespace {

// dV/dq and dT/dp share no variable, so one pass lowers both; what depends on parameters alone is
// computed once per run.
void build_splitting(Program& program, const Mechanics& mechanics) {
  Lowering lowering({Section{}, Section{}, Section{}});
  const int n = mechanics.degrees_of_freedom;
  for (const Quantity& parameter : mechanics.parameters) lowering.declare(parameter.name, 0);
  std::vector<std::size_t> handles;
  for (int i = 0; i < 2 * n; ++i) {
    lowering.declare(mechanics.variable(i).name(), i < n ? 1 : 2);
    handles.push_back(
        lowering.want(mechanics.gradient[static_cast<std::size_t>(i)], i < n ? 1 : 2));
  }
  lowering.run();
  program.coefficients = lowering.statements(0);
  program.potential_gradient.statements = lowering.statements(1);
  program.kinetic_gradient.statements = lowering.statements(2);
  for (int i = 0; i < 2 * n; ++i) {
    (i < n ? program.potential_gradient : program.kinetic_gradient)
        .results.push_back(lowering.wanted(handles[static_cast<std::size_t>(i)]));
  }
}

void build_hessian(Program& program, const Mechanics& mechanics) {
  std::vector<Expression> values;
  for (const auto& [place, value] : mechanics.hessian) {
    program.hessian_places.push_back(place);
    values.push_back(value);
  }
  program.hessian = evaluate_together(values);
}

}  // namespace

Program with_hessian(Program program) {
  if (!program.hessian_places.empty()) return program;
  build_hessian(program, program.plan.equations.mechanics);
  return program;
}

Program build_program(const SolvePlan& plan) {
  const Mechanics& mechanics = plan.equations.mechanics;
  Program program{.plan = plan};
  if (!plan.arrays) {
    if (plan.equations.scheme.has_member()) program = Builder(plan).build();
    if (std::holds_alternative<Splitting>(plan.equations.scheme.method)) {
      build_splitting(program, mechanics);
    }
    if (plan.stage_solver) build_hessian(program, mechanics);
    program.energy = evaluate_together({mechanics.energy});
    program.gradient = evaluate_together(plan.equations.function ? plan.equations.energy_gradient
                                                                 : mechanics.gradient);
  }
  std::vector<Expression> invariants;
  for (const NamedExpression& invariant : mechanics.invariants)
    invariants.push_back(invariant.value);
  program.invariants = evaluate_together(invariants);
  return program;
}

namespace {

void add_cost(const Expression& e, Cost& total) {
  for (const Expression& operand : e.operands()) {
    if (!operand.is_number()) add_cost(operand, total);
  }
  switch (e.kind()) {
    case Kind::number:
    case Kind::symbol:
      return;
    case Kind::sum:
      total.additions += static_cast<int>(e.operands().size()) - 1;
      return;
    case Kind::function:
      ++total.functions;
      return;
    case Kind::power:
      if (e.operands()[1] == Expression(-1)) {
        ++total.divisions;
      } else if (e.operands()[1].is_number() && e.operands()[1].number().get_den() == 1) {
        ++total.multiplications;
      } else {
        ++total.functions;
      }
      return;
    case Kind::product: {
      int factors = 0;
      bool reciprocal = false;
      for (const Expression& operand : e.operands()) {
        const bool divides =
            operand.kind() == Kind::power && operand.operands()[1] == Expression(-1);
        reciprocal = reciprocal || divides;
        if (!divides && operand != Expression(-1)) ++factors;
      }
      total.multiplications += std::max(0, factors - 1);
      return;
    }
  }
}

void print(std::string& text, const std::vector<Statement>& statements, const char* indent) {
  for (const Statement& s : statements) {
    text += fmt::format("{}{} = {}\n", indent, s.name, to_text(s.value));
  }
}

}  // namespace

Cost cost(const std::vector<Statement>& statements) {
  Cost total;
  for (const Statement& statement : statements) add_cost(statement.value, total);
  return total;
}

std::string to_text(const Cost& cost) {
  std::string text;
  auto add = [&](int count, const char* what) {
    if (count != 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(cost.additions + cost.multiplications, "+ - *");
  add(cost.divisions, "/");
  add(cost.functions, "sqrt and functions");
  return text.empty() ? "nothing" : text;
}

std::string to_text(const Program& program) {
  std::string text = "once per run:\n";
  print(text, program.coefficients, "  ");
  for (const Stage& stage : program.stages) {
    text += "straight-line:\n";
    print(text, stage.before, "  ");
    if (stage.solve) {
      const Solve& solve = *stage.solve;
      text += solve.sweeps                      ? fmt::format("{} sweeps:\n", *solve.sweeps)
              : solve.kind == BlockKind::linear ? std::string("solve:\n")
                                                : std::string("iterate:\n");
      print(text, solve.body, "  ");
      for (std::size_t i = 0; i < solve.residual.size(); ++i) {
        text += fmt::format("  residual {} = {}\n", i + 1, to_text(solve.residual[i]));
        for (std::size_t j = 0; j < solve.matrix[i].size(); ++j) {
          if (solve.matrix[i][j].is_zero()) continue;
          text += fmt::format("  matrix {} {} = {}\n", i + 1, j + 1, to_text(solve.matrix[i][j]));
        }
      }
      for (const LoopVariable& v : solve.variables) {
        if (solve.kind == BlockKind::fixed_point) {
          text += fmt::format("  next {} = {}\n", v.name, to_text(v.next));
        }
      }
      text += "then:\n";
      print(text, stage.after, "  ");
    }
  }
  text += "increments:\n";
  for (std::size_t i = 0; i < program.increments.size(); ++i) {
    text += fmt::format("  {}: {}\n", program.plan.equations.mechanics.variables[i].name,
                        to_text(program.increments[i]));
  }
  return text;
}

}  // namespace hamgen
