#include "generator/program/linearisation.hpp"

#include <algorithm>
#include <map>

#include "generator/program/lower.hpp"

namespace hamgen {

namespace {

// Sections of the lowering: of h and parameters, of the stage values, then of a displacement.
constexpr int kOfStage = 1;
constexpr int kOfDisplacement = 2;

class Lineariser {
 public:
  explicit Lineariser(const SolvePlan& plan)
      : equations_(plan.equations),
        blocks_(plan.blocks),
        n_(plan.equations.mechanics.degrees_of_freedom),
        lowering_(std::vector<Section>(3 + plan.blocks.size())) {
    for (const Quantity& parameter : equations_.mechanics.parameters) {
      lowering_.declare(parameter.name, 0);
    }
    for (const char* name : {"h", "E0"}) lowering_.declare(name, 0);
    for (int i = 0; i < 2 * n_; ++i) {
      lowering_.declare(name(i), kOfStage);
      lowering_.declare("dz(" + name(i) + ")", kOfStage);
      lowering_.declare("u(" + name(i) + ")", kOfDisplacement);
    }
    define_stage_values();
  }

  Linearisation run() {
    for (const Block& block : blocks_) solve(block);
    std::vector<std::size_t> results;
    for (int i = 0; i < 2 * n_; ++i) {
      const int k = i < n_ ? i + n_ : i - n_;
      const Expression slope = slope_along(k, [&](int v) { return moved_.at(v); });
      results.push_back(
          lowering_.want(displacement(i) + (i < n_ ? step_size() : -step_size()) * slope, now_));
    }
    lowering_.run();
    Linearisation result{.once = lowering_.statements(0)};
    const auto& of_stage = lowering_.statements(kOfStage);
    result.once.insert(result.once.end(), of_stage.begin(), of_stage.end());
    for (int section = kOfDisplacement; section <= now_; ++section) {
      auto& stage = result.stages.emplace_back();
      stage.before = lowering_.statements(section);
      const auto at = static_cast<std::size_t>(section - kOfDisplacement);
      if (at < solves_.size()) stage.solve = finished(solves_[at]);
    }
    for (const std::size_t handle : results) result.results.push_back(lowering_.wanted(handle));
    return result;
  }

 private:
  struct Pending {
    std::vector<std::vector<std::size_t>> matrix;
    std::vector<std::size_t> right_side;
    std::vector<std::string> solution;
  };

  [[nodiscard]] std::string name(int i) const {
    return equations_.mechanics.variables.name(static_cast<std::size_t>(i));
  }
  [[nodiscard]] Expression displacement(int i) const {
    return Expression::symbol("u(" + name(i) + ")", kRankOfVariable + i);
  }
  Expression named(const std::string& text, const Expression& value, int section) {
    if (is_trivial(value)) return value;
    lowering_.define(text, value, section);
    return Expression::symbol(text, kRankOfTemporary);
  }

  // zbar = z + (I/2 + C) dz.
  void define_stage_values() {
    const SparseMatrix& c = equations_.scheme.member().c;
    for (int i = 0; i < 2 * n_; ++i) {
      Expression sum = equations_.mechanics.variable(i);
      for (int j = 0; j < 2 * n_; ++j) {
        const auto it = c.find({i, j});
        Expression entry = it == c.end() ? Expression(0) : it->second;
        if (i == j) entry += Expression(Rational(1, 2));
        if (entry.is_zero()) continue;
        sum += entry * Expression::symbol("dz(" + name(j) + ")", kRankOfVariable + j);
      }
      lowering_.define(equations_.stage(i).name(), sum, kOfStage);
      moved_.emplace(i, Expression(0));  // until its block is solved; H'' does not look before
    }
  }

  Expression hessian(int k, int v) {
    const Expression symbol = equations_.hessian_symbol(k, v);
    if (symbol.is_zero() || !hessian_.insert(symbol.name()).second) return symbol;
    lowering_.define(symbol.name(), equations_.stage_hessian(k, v), kOfStage);
    return symbol;
  }

  // sum_v H_kv value(v)
  template <class Value>
  Expression slope_along(int k, const Value& value) {
    std::vector<Expression> terms;
    for (int v = 0; v < 2 * n_; ++v) {
      const Expression factor = value(v);
      if (!factor.is_zero() && !equations_.hessian_symbol(k, v).is_zero()) {
        terms.push_back(hessian(k, v) * factor);
      }
    }
    return Expression::sum(std::move(terms));
  }
  // sum_k h B_ik sum_v H_kv value(v)
  template <class Value>
  Expression row(int i, const Value& value) {
    std::vector<Expression> terms;
    for (const int k : equations_.row_gradients(i)) {
      terms.push_back(step_size() * equations_.stage_matrix.at({i, k}) * slope_along(k, value));
    }
    return Expression::sum(std::move(terms));
  }

  // dzbar_v = fixed_v + sum_j slopes_v[j] x_j for the unknowns x of a block.
  void solve(const Block& block) {
    std::vector<int> unknowns = block.unknowns;
    std::vector<int> torn = block.torn;
    const bool explicit_rows =
        block.kind == BlockKind::assign || block.kind == BlockKind::quadratic;
    if (explicit_rows) std::swap(unknowns, torn);
    const std::size_t m = unknowns.size();
    std::map<int, std::vector<Expression>> slopes;
    for (std::size_t j = 0; j < m; ++j) {
      slopes[unknowns[j]].resize(m);
      slopes[unknowns[j]][j] = Expression(1);
      moved_.at(unknowns[j]) = Expression(0);
    }
    auto fixed = [&](int v) { return moved_.at(v); };
    auto slope = [&](std::size_t j) {
      return [&slopes, j](int v) {
        const auto it = slopes.find(v);
        return it == slopes.end() ? Expression(0) : it->second[j];
      };
    };
    for (const int t : torn) {
      const Expression own = row(t, [&](int v) { return Expression(v == t ? 1 : 0); });
      const Expression rest = Expression(1) - named("own(" + name(t) + ")", own, kOfStage);
      const Expression inverse = Expression::power(rest, Expression(-1));
      std::vector<Expression> of_t;
      for (std::size_t j = 0; j < m; ++j) {
        of_t.push_back(named("d(" + name(t) + ")/d(" + name(unknowns[j]) + ")",
                             row(t, slope(j)) * inverse, kOfStage));
      }
      moved_.at(t) =
          named("fixed(" + name(t) + ")", (displacement(t) + row(t, fixed)) * inverse, now_);
      slopes[t] = std::move(of_t);
    }
    if (m == 0) return;
    std::vector<Expression> right_side;
    std::vector<std::vector<Expression>> matrix;
    for (const int x : unknowns) {
      right_side.push_back(displacement(x) + row(x, fixed));
      auto& line = matrix.emplace_back();
      for (std::size_t j = 0; j < m; ++j) {
        line.push_back(Expression(unknowns[j] == x ? 1 : 0) - row(x, slope(j)));
      }
    }
    const std::vector<Expression> x = solution(unknowns, matrix, right_side);
    for (std::size_t j = 0; j < m; ++j) moved_.at(unknowns[j]) = x[j];
    for (const int t : torn) {
      std::vector<Expression> terms{moved_.at(t)};
      for (std::size_t j = 0; j < m; ++j) terms.push_back(slopes.at(t)[j] * x[j]);
      moved_.at(t) = named("moved(" + name(t) + ")", Expression::sum(std::move(terms)), now_);
    }
  }

  std::vector<Expression> solution(const std::vector<int>& unknowns,
                                   const std::vector<std::vector<Expression>>& matrix,
                                   const std::vector<Expression>& right_side) {
    const std::size_t m = unknowns.size();
    if (m <= 3) return by_cofactors(unknowns, matrix, right_side);
    Pending pending;
    std::vector<Expression> result;
    for (std::size_t i = 0; i < m; ++i) {
      auto& line = pending.matrix.emplace_back();
      for (const Expression& entry : matrix[i]) line.push_back(lowering_.want(entry, kOfStage));
      pending.right_side.push_back(lowering_.want(right_side[i], now_));
      pending.solution.push_back("moved(" + name(unknowns[i]) + ")");
      lowering_.declare(pending.solution.back(), now_ + 1);
      result.push_back(Expression::symbol(pending.solution.back(), kRankOfTemporary));
    }
    solves_.push_back(std::move(pending));
    ++now_;
    return result;
  }

  // Cramer's rule, as the step writes it out.
  std::vector<Expression> by_cofactors(const std::vector<int>& unknowns,
                                       const std::vector<std::vector<Expression>>& matrix,
                                       const std::vector<Expression>& right_side) {
    const std::size_t m = unknowns.size();
    auto label = [&](const char* what, std::size_t i) {
      return std::string(what) + "(" + name(unknowns[i]) + ")";
    };
    std::vector<std::vector<Expression>> a(m);
    std::vector<Expression> r;
    for (std::size_t i = 0; i < m; ++i) {
      r.push_back(named(label("r", i), right_side[i], now_));
      for (std::size_t j = 0; j < m; ++j) {
        a[i].push_back(named("R(" + name(unknowns[i]) + "," + name(unknowns[j]) + ")", matrix[i][j],
                             kOfStage));
      }
    }
    auto cofactor = [&](std::size_t i, std::size_t j) -> Expression {
      if (m == 1) return Expression(1);
      if (m == 2) return i == j ? a[1 - i][1 - j] : -a[1 - i][1 - j];
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      return a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
    };
    Expression determinant(0);
    for (std::size_t j = 0; j < m; ++j) determinant += a[0][j] * cofactor(0, j);
    const Expression inverse =
        named(label("1/det", 0), Expression::power(determinant, Expression(-1)), kOfStage);
    std::vector<Expression> result;
    for (std::size_t j = 0; j < m; ++j) {
      std::vector<Expression> terms;
      for (std::size_t i = 0; i < m; ++i) terms.push_back(cofactor(i, j) * r[i]);
      result.push_back(named(label("moved", j), inverse * Expression::sum(std::move(terms)), now_));
    }
    return result;
  }

  [[nodiscard]] LinearisedSolve finished(const Pending& pending) const {
    LinearisedSolve solve{.matrix = {}, .right_side = {}, .solution = pending.solution};
    for (const auto& line : pending.matrix) {
      auto& row = solve.matrix.emplace_back();
      for (const std::size_t handle : line) row.push_back(lowering_.wanted(handle));
    }
    for (const std::size_t handle : pending.right_side) {
      solve.right_side.push_back(lowering_.wanted(handle));
    }
    return solve;
  }

  const StepEquations& equations_;
  const std::vector<Block>& blocks_;
  int n_;
  Lowering lowering_;
  int now_ = kOfDisplacement;
  std::map<int, Expression> moved_;  // dzbar_v as far as it is known
  std::set<std::string> hessian_;    // entries that are defined
  std::vector<Pending> solves_;
};

}  // namespace

Linearisation linearise(const SolvePlan& plan) { return Lineariser(plan).run(); }

}  // namespace hamgen
