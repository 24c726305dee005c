#include "generator/verify/expected_step.hpp"

#include <ginac/ginac.h>

#include <algorithm>
#include <optional>

#include "generator/algebra/from_ginac.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

Derivatives::Derivatives(const Mechanics& mechanics) {
  SymbolTable table;
  std::vector<GiNaC::ex> variables;
  for (std::size_t i = 0; i < mechanics.variables.size(); ++i) {
    variables.push_back(
        table.symbol(mechanics.variables[i].name, kRankOfVariable + static_cast<int>(i)));
  }
  const GiNaC::ex energy = to_ginac(mechanics.energy, table);
  const int size = static_cast<int>(variables.size());
  for (int i = 0; i < size; ++i) {
    const auto row = static_cast<std::size_t>(i);
    const GiNaC::ex slope = energy.diff(GiNaC::ex_to<GiNaC::symbol>(variables[row]));
    gradient_.push_back(is_zero_by_algebra(from_ginac(slope, table)) ? Expression(0)
                                                                     : from_ginac(slope, table));
    const std::set<std::string> present = symbols(gradient_.back());
    for (int j = i; j < size; ++j) {
      const auto column = static_cast<std::size_t>(j);
      if (!present.contains(mechanics.variables[column].name)) continue;
      const Expression entry =
          from_ginac(slope.diff(GiNaC::ex_to<GiNaC::symbol>(variables[column])), table);
      if (!is_zero_by_algebra(entry)) hessian_.emplace(std::pair(i, j), entry);
    }
  }
}

Expression Derivatives::second(int i, int j) const {
  const auto it = hessian_.find(std::minmax(i, j));
  return it == hessian_.end() ? Expression(0) : it->second;
}

namespace {

class ExpectedStep {
 public:
  ExpectedStep(const Mechanics& mechanics, const Derivatives& derivatives, const Member& member,
               const Program& program)
      : mechanics_(mechanics),
        n_(mechanics.degrees_of_freedom),
        derivatives_(derivatives),
        program_(program) {
    add(program.coefficients);
    for (const Stage& stage : program.stages) {
      add(stage.before);
      if (stage.solve) {
        add(stage.solve->body);
        solves_.push_back(&*stage.solve);
      }
      add(stage.after);
    }
    for (int i = 0; i < 2 * n_; ++i) bar_.push_back(free("bar", i));
    gradient_.resize(at(2 * n_));
    set_weights(member);
  }

  Identities run() {
    if (program_.plan.sweeps) {
      sweep();
    } else {
      for (const Block& block : program_.plan.blocks) solve(block);
      if (next_solve_ != solves_.size()) internal_error("a solve that no block asks for");
    }
    for (int i = 0; i < 2 * n_; ++i) {
      const Expression slope = gradient(i < n_ ? i + n_ : i - n_);
      const Expression h = i < n_ ? h_ : -h_;
      const auto change = change_.find(i < n_ ? i + n_ : i - n_);
      Expression expected = carry(i) + h * slope;
      if (change != change_.end()) {
        expected = h * change->second.first +
                   define("rest(d" + name(i) + ")", carry(i) + h * change->second.second);
      }
      claim("the increment of " + name(i), program_.increments[at(i)], expected);
    }
    return std::move(identities_);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] const std::string& name(int i) const { return mechanics_.variables[at(i)].name; }
  [[nodiscard]] Expression free(const std::string& what, int i) const {
    return Expression::symbol(what + "(" + name(i) + ")", kRankOfVariable + i);
  }

  void add(const std::vector<Statement>& statements) {
    identities_.emitted.insert(identities_.emitted.end(), statements.begin(), statements.end());
  }
  void claim(std::string what, const Expression& emitted, const Expression& expected) {
    identities_.claims.push_back({std::move(what), emitted, expected});
  }
  Expression define(const std::string& what, const Expression& value) {
    if (value.is_number()) return value;
    std::string unique = "=" + what;
    while (!names_.insert(unique).second) unique += "*";
    identities_.expected.push_back({unique, value});
    return Expression::symbol(unique);
  }

  // h (I/2 + C) J: row i of zbar = z + h (I/2 + C) J grad H(zbar).
  void set_weights(const Member& member) {
    for (int i = 0; i < 2 * n_; ++i) {
      for (int j = 0; j < 2 * n_; ++j) {
        const auto it = member.c.find({i, j});
        Expression entry = it == member.c.end() ? Expression(0) : it->second;
        if (i == j) entry += Expression(Rational(1, 2));
        if (entry.is_zero()) continue;
        // (J g)_j = g_{j+n} for a coordinate, -g_{j-n} for a momentum.
        const int k = j < n_ ? j + n_ : j - n_;
        if (derivatives_.first(k).is_zero()) continue;
        weights_[i].emplace_back(k, h_ * (j < n_ ? entry : -entry));
      }
    }
  }

  // An expression in z at the present stage values.
  [[nodiscard]] Expression at_stage(const Expression& e) const {
    Substitution stage;
    for (int i = 0; i < 2 * n_; ++i) stage.emplace(name(i), bar_[at(i)]);
    return substitute(e, stage);
  }

  // A derivative of H is evaluated where it is first asked for.
  Expression gradient(int k) {
    if (!gradient_[at(k)]) {
      gradient_[at(k)] = define("H(" + name(k) + ")", at_stage(derivatives_.first(k)));
    }
    return *gradient_[at(k)];
  }

  // What rounding took from z_i: the step starts from the sum of both.
  [[nodiscard]] Expression carry(int i) const {
    const bool changes = !derivatives_.first(i < n_ ? i + n_ : i - n_).is_zero();
    return changes ? free("carry", i) : Expression(0);
  }

  // z_i + carry_i + h sum B_ik H_k.
  Expression row(int i) {
    Expression sum = mechanics_.variable(i) + carry(i);
    for (const auto& [k, weight] : weights_[i]) sum += weight * gradient(k);
    return sum;
  }

  void solve(const Block& block) {
    switch (block.kind) {
      case BlockKind::assign: {
        const int i = block.unknowns[0];
        bar_[at(i)] = define("bar(" + name(i) + ")", row(i));
        return;
      }
      case BlockKind::quadratic:
        quadratic(block.unknowns[0]);
        return;
      case BlockKind::linear:
      case BlockKind::newton:
        newton(block);
        return;
      case BlockKind::fixed_point:
        fixed_point(block);
        return;
    }
  }

  // F(x) = x - z_i - sum w_k H_k(x) is of degree two: F(z_i + d) = c0 + c1 d + c2 d^2.
  void quadratic(int i) {
    const Expression x = Expression::symbol("x");
    auto with = [&](const Expression& e, const Expression& value) {
      bar_[at(i)] = value;
      return at_stage(e);
    };
    const Expression z = mechanics_.variable(i);
    Expression c0(0);
    Expression c1(1);
    Expression c2(0);
    for (const auto& [k, weight] : weights_[i]) {
      const Expression slope = derivatives_.second(k, i);
      c0 += -(weight * with(derivatives_.first(k), z));
      c1 += -(weight * with(slope, z));
      c2 += -(weight * (with(slope, z + Expression(1)) - with(slope, z)) / Expression(2));
    }
    const Expression named0 = define("c0(" + name(i) + ")", c0);
    const Expression named1 = define("c1(" + name(i) + ")", c1);
    const Expression named2 = define("c2(" + name(i) + ")", c2);
    const Expression d = Expression(-2) * named0 /
                         (named1 + square_root(named1 * named1 - Expression(4) * named0 * named2));
    bar_[at(i)] = define("bar(" + name(i) + ")", z + d);
    claim("the root of the equation for " + name(i), named1 * d + named2 * d * d, -named0);
  }

  const Solve& next_solve(BlockKind kind) {
    if (next_solve_ == solves_.size() || solves_[next_solve_]->kind != kind) {
      internal_error("a block without its solve");
    }
    return *solves_[next_solve_++];
  }

  void newton(const Block& block) {
    const bool linear = block.kind == BlockKind::linear;
    const std::size_t m = block.unknowns.size();
    second_.clear();  // those of an earlier block are taken before its last increment
    const Solve* solve = nullptr;
    if (!linear || m > 3) solve = &next_solve(block.kind);
    std::vector<int> members;
    std::map<int, std::vector<Expression>> slopes;  // d(member)/d(unknown)
    for (std::size_t j = 0; j < m; ++j) {
      const int x = block.unknowns[j];
      // An affine system is solved from 0.
      bar_[at(x)] = linear ? Expression(0) : free("bar", x);
      slopes[x] = std::vector<Expression>(m, Expression(0));
      slopes[x][j] = Expression(1);
      members.push_back(x);
      if (solve != nullptr && !linear) {
        claim("the start of " + name(x), solve->variables.at(j).cold, mechanics_.variable(x));
      }
    }
    auto second = [&](int k, int v) {
      const auto [a, b] = std::minmax(k, v);
      const Expression value = derivatives_.second(a, b);
      if (value.is_zero()) return value;
      const std::string what = "H(" + name(a) + "," + name(b) + ")";
      const auto it = second_.find({a, b});
      if (it != second_.end()) return it->second;
      return second_.emplace(std::pair(a, b), define(what, at_stage(value))).first->second;
    };
    // d(row i)/d(unknown j) along the members found so far.
    auto slope_of_row = [&](int i, std::size_t j) {
      Expression sum(0);
      for (const auto& [k, weight] : weights_[i]) {
        for (const int v : members) sum += weight * second(k, v) * slopes.at(v)[j];
      }
      return sum;
    };
    std::vector<int> evaluated;
    auto evaluate_row = [&](int i) {
      for (const auto& [k, weight] : weights_[i]) {
        if (!gradient_[at(k)]) evaluated.push_back(k);
        (void)gradient(k);
      }
    };
    for (const int t : block.torn) {
      // bar_t = a + b bar_t with b = sum w_k H_kt.
      Expression b(0);
      for (const auto& [k, weight] : weights_[t]) b += weight * at_stage(derivatives_.second(k, t));
      if (!b.is_zero()) {
        bar_[at(t)] = Expression(0);
        Expression a = mechanics_.variable(t) + carry(t);
        for (const auto& [k, weight] : weights_[t]) a += weight * at_stage(derivatives_.first(k));
        bar_[at(t)] = define("bar(" + name(t) + ")", a / (Expression(1) - b));
        evaluate_row(t);
      } else {
        evaluate_row(t);
        bar_[at(t)] = define("bar(" + name(t) + ")", row(t));
      }
      std::vector<Expression> slope;
      for (std::size_t j = 0; j < m; ++j) {
        slope.push_back(define("d(" + name(t) + ")/d(" + name(block.unknowns[j]) + ")",
                               slope_of_row(t, j) / (Expression(1) - b)));
      }
      slopes[t] = std::move(slope);
      members.push_back(t);
    }
    std::vector<Expression> residual;
    std::vector<std::vector<Expression>> matrix;
    for (std::size_t i = 0; i < m; ++i) {
      const int x = block.unknowns[i];
      evaluate_row(x);
      const std::string r = "R(" + name(x);
      residual.push_back(define(r + ")", bar_[at(x)] - row(x)));
      auto& line = matrix.emplace_back();
      for (std::size_t j = 0; j < m; ++j) {
        line.push_back(define(r + "," + name(block.unknowns[j]) + ")",
                              Expression(i == j ? 1 : 0) - slope_of_row(x, j)));
      }
    }
    std::vector<Expression> delta;
    if (m > 3) {
      for (std::size_t i = 0; i < m; ++i) {
        const std::string& x = name(block.unknowns[i]);
        claim("the residual of " + x, solve->residual.at(i), residual[i]);
        for (std::size_t j = 0; j < m; ++j) {
          claim("the derivative of the residual of " + x + " by " + name(block.unknowns[j]),
                solve->matrix.at(i).at(j), matrix[i][j]);
        }
        delta.push_back(Expression::symbol(solve->corrections.at(i)));
      }
    } else {
      delta = newton_increments(block, residual, matrix);
      for (std::size_t j = 0; solve != nullptr && j < m; ++j) {
        claim("Newton's increment of " + name(block.unknowns[j]), solve->variables.at(j).correction,
              delta[j]);
      }
    }
    // To first order in the increments.
    std::map<int, Expression> moved;
    for (const int v : members) {
      Expression sum(0);
      for (std::size_t j = 0; j < m; ++j) sum += slopes.at(v)[j] * delta[j];
      moved[v] = sum;
    }
    // Rows of torn variables that need corrected gradients alone are computed anew, and then what
    // is linear in these variables: the same to first order.
    std::set<int> anew;
    for (const int t : block.torn) {
      const bool direct = !linear && std::ranges::all_of(weights_[t], [&](const auto& term) {
        const int k = term.first;
        return derivatives_.second(k, t).is_zero() && !is_linear_in(k, block.torn) &&
               std::ranges::find(evaluated, k) != evaluated.end();
      });
      if (direct) anew.insert(t);
    }
    const auto is_anew = [&](int k) { return is_linear_in(k, anew); };
    for (const int k : evaluated) {
      if (is_anew(k)) continue;
      Expression sum(0);
      for (const int v : members) sum += second(k, v) * moved[v];
      if (sum.is_zero()) continue;
      const Expression change = define("change(H(" + name(k) + "))", sum);
      change_[k] = {*gradient_[at(k)], change};
      gradient_[at(k)] = define("H(" + name(k) + ")*", *gradient_[at(k)] + change);
    }
    for (const int v : members) {
      bar_[at(v)] =
          define("bar(" + name(v) + ")*", anew.contains(v) ? row(v) : bar_[at(v)] + moved[v]);
    }
    for (const int k : evaluated) {
      if (is_anew(k))
        gradient_[at(k)] = define("H(" + name(k) + ")*", at_stage(derivatives_.first(k)));
    }
  }

  // Is H_k linear with constant coefficients in some of these variables and free of all others?
  template <class Variables>
  [[nodiscard]] bool is_linear_in(int k, const Variables& variables) const {
    bool any = false;
    for (int v = 0; v < 2 * n_; ++v) {
      const Expression slope = derivatives_.second(k, v);
      if (slope.is_zero()) continue;
      if (std::ranges::find(variables, v) == std::ranges::end(variables)) return false;
      const std::set<std::string> used = symbols(slope);
      for (const Quantity& variable : mechanics_.variables) {
        if (used.contains(variable.name)) return false;
      }
      any = true;
    }
    return any;
  }

  // -R'^-1 R by the adjugate.
  std::vector<Expression> newton_increments(const Block& block, const std::vector<Expression>& r,
                                            const std::vector<std::vector<Expression>>& a) {
    const std::size_t m = r.size();
    auto minor = [&](std::size_t row, std::size_t column) {
      std::vector<std::size_t> rows;
      std::vector<std::size_t> columns;
      for (std::size_t k = 0; k < m; ++k) {
        if (k != row) rows.push_back(k);
        if (k != column) columns.push_back(k);
      }
      if (m == 1) return Expression(1);
      if (m == 2) return a[rows[0]][columns[0]];
      return a[rows[0]][columns[0]] * a[rows[1]][columns[1]] -
             a[rows[0]][columns[1]] * a[rows[1]][columns[0]];
    };
    auto cofactor = [&](std::size_t i, std::size_t j) {
      return (i + j) % 2 == 0 ? minor(i, j) : -minor(i, j);
    };
    Expression determinant(0);
    for (std::size_t j = 0; j < m; ++j) determinant += a[0][j] * cofactor(0, j);
    const Expression inverse = define("1/det(" + name(block.unknowns[0]) + ")",
                                      Expression::power(determinant, Expression(-1)));
    std::vector<Expression> delta;
    for (std::size_t j = 0; j < m; ++j) {
      Expression sum(0);
      for (std::size_t i = 0; i < m; ++i) sum += cofactor(i, j) * r[i];
      delta.push_back(define("delta(" + name(block.unknowns[j]) + ")", -(inverse * sum)));
    }
    return delta;
  }

  void fixed_point(const Block& block) {
    const Solve& solve = next_solve(BlockKind::fixed_point);
    for (const int x : block.unknowns) bar_[at(x)] = free("bar", x);
    for (const int t : block.torn) bar_[at(t)] = define("bar(" + name(t) + ")", row(t));
    for (std::size_t j = 0; j < block.unknowns.size(); ++j) {
      const int x = block.unknowns[j];
      claim("the start of " + name(x), solve.variables.at(j).cold, mechanics_.variable(x));
      claim("the next value of " + name(x), solve.variables.at(j).next, row(x));
    }
  }

  // In terms of the gradient g: first grad H(z), then K times grad H(zbar(g)).
  void sweep() {
    const Solve& solve = *solves_.at(0);
    std::vector<int> components;
    for (int k = 0; k < 2 * n_; ++k) {
      gradient_[at(k)] = Expression(0);
      if (derivatives_.first(k).is_zero()) continue;
      components.push_back(k);
      gradient_[at(k)] = free("H", k);
    }
    for (int i = 0; i < 2 * n_; ++i) bar_[at(i)] = define("bar(" + name(i) + ")", row(i));
    for (std::size_t j = 0; j < components.size(); ++j) {
      const int k = components[j];
      const LoopVariable& variable = solve.variables.at(j);
      claim("the predictor of dH/d" + name(k), variable.cold, derivatives_.first(k));
      claim("the next dH/d" + name(k), variable.next, at_stage(derivatives_.first(k)));
      gradient_[at(k)] = Expression::symbol("H(" + name(k) + ")*");
    }
    claim("the number of sweeps", Expression(solve.sweeps.value_or(-1)),
          Expression(*program_.plan.sweeps));
  }

  const Mechanics& mechanics_;
  const int n_;
  const Derivatives& derivatives_;
  const Program& program_;
  const Expression h_ = Expression::symbol("h", kRankOfStep);
  std::map<int, std::vector<std::pair<int, Expression>>> weights_;
  std::vector<Expression> bar_;
  std::vector<std::optional<Expression>> gradient_;
  std::map<int, std::pair<Expression, Expression>>
      change_;  // before the last increment, and what it adds
  std::map<std::pair<int, int>, Expression> second_;
  std::vector<const Solve*> solves_;
  std::size_t next_solve_ = 0;
  std::set<std::string> names_;
  Identities identities_;
};

}  // namespace

Identities step_identities(const Mechanics& mechanics, const Derivatives& derivatives,
                           const Member& member, const Program& program) {
  return ExpectedStep(mechanics, derivatives, member, program).run();
}

}  // namespace hamgen
