// Newton's iteration on a block, exact and simplified.
#include <algorithm>

#include "generator/verify/expected_builder.hpp"

namespace hamgen {

// Two derivatives of H at the stage; each is computed once.
Expression ExpectedStep::second(int k, int v) {
  const auto [a, b] = std::minmax(k, v);
  const Expression value = derivatives_.second(a, b);
  if (value.is_zero()) return value;
  const auto it = second_.find({a, b});
  if (it != second_.end()) return it->second;
  const Expression symbol = define("H(" + name(a) + "," + name(b) + ")", at_stage(value));
  return second_.emplace(std::pair(a, b), symbol).first->second;
}

// Solved for from 0, and then for what its row lacks there.
Expression ExpectedStep::affine_value(int t, const Expression& own) {
  const auto row_at = [&](const Expression& value) {
    bar_[at(t)] = value;
    Expression sum = mechanics_.variable(t) + carry(t);
    for (const auto& [k, weight] : weights_[t]) sum += weight * at_stage(derivatives_.first(k));
    return sum;
  };
  const Expression first = define("first(" + name(t) + ")", row_at(Expression(0)) / own);
  return define("bar(" + name(t) + ")", first - (first - row_at(first)) / own);
}

Expression ExpectedStep::along(int i, const std::vector<int>& variables,
                               const std::function<Expression(int)>& value) {
  Expression sum(0);
  for (const auto& [k, weight] : weights_[i]) {
    for (const int v : variables) sum += weight * second(k, v) * value(v);
  }
  return sum;
}

void ExpectedStep::newton(const Block& block) {
  const std::size_t m = block.unknowns.size();
  second_.clear();  // those of an earlier block are taken before its last increment
  const Solve* solve = &next_solve(BlockKind::newton);
  std::vector<int> members;
  std::map<int, std::vector<Expression>> slopes;  // d(member)/d(unknown)
  for (std::size_t j = 0; j < m; ++j) {
    const int x = block.unknowns[j];
    bar_[at(x)] = free("bar", x);
    slopes[x] = std::vector<Expression>(m, Expression(0));
    slopes[x][j] = Expression(1);
    members.push_back(x);
    claim("the start of " + name(x), solve->variables.at(j).cold, mechanics_.variable(x));
  }
  // d(row i)/d(unknown j) along the members found so far.
  auto slope_of_row = [&](int i, std::size_t j) {
    return along(i, members, [&](int v) { return slopes.at(v)[j]; });
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
      bar_[at(t)] = affine_value(t, Expression(1) - b);
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
  const std::vector<Expression> delta = increments(block, residual, matrix, solve);
  for (std::size_t j = 0; m <= 3 && j < m; ++j) {
    claim("Newton's increment of " + name(block.unknowns[j]), solve->variables.at(j).correction,
          delta[j]);
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
  const std::set<int> torn(block.torn.begin(), block.torn.end());
  std::set<int> anew;
  for (const int t : block.torn) {
    const bool direct = std::ranges::all_of(weights_[t], [&](const auto& term) {
      const int k = term.first;
      return derivatives_.second(k, t).is_zero() && !is_linear_in(k, torn) &&
             std::ranges::find(evaluated, k) != evaluated.end();
    });
    if (direct) anew.insert(t);
  }
  const auto is_anew = [&](int k) { return is_linear_in(k, anew); };
  for (const int k : evaluated) {
    if (is_anew(k)) continue;
    Expression sum(0);
    for (const int v : members) sum += second(k, v) * moved[v];
    correct_gradient(k, sum);
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

// With H_kv of a shorter K:  (1 - h B H'') delta = -(bar - row) over all variables of the block,
// where those of `torn` are eliminated first: delta_t = -R_t + sum_j slope_tj delta_j.
void ExpectedStep::simplified_newton(const Block& block) {
  const std::size_t m = block.unknowns.size();
  second_.clear();
  const Solve& solve = next_solve(block.kind);
  std::vector<int> all = block.unknowns;
  all.insert(all.end(), block.torn.begin(), block.torn.end());
  std::vector<int> evaluated;
  for (std::size_t j = 0; j < all.size(); ++j) {
    bar_[at(all[j])] = free("bar", all[j]);
    claim("the start of " + name(all[j]), solve.variables.at(j).cold, mechanics_.variable(all[j]));
  }
  for (const int v : all) {
    for (const auto& [k, weight] : weights_[v]) {
      if (!gradient_[at(k)]) evaluated.push_back(k);
      (void)gradient(k);
    }
  }
  std::vector<int> members = block.unknowns;
  std::map<int, Expression> lacking;  // delta_v without what the unknowns add
  std::map<int, std::vector<Expression>> slopes;
  for (std::size_t j = 0; j < m; ++j) {
    lacking[block.unknowns[j]] = Expression(0);
    slopes[block.unknowns[j]] = std::vector<Expression>(m, Expression(0));
    slopes[block.unknowns[j]][j] = Expression(1);
  }
  auto residual_of = [&](int i) {
    return bar_[at(i)] - row(i) - along(i, members, [&](int v) { return lacking.at(v); });
  };
  auto slope_of_row = [&](int i, std::size_t j) {
    return along(i, members, [&](int v) { return slopes.at(v)[j]; });
  };
  for (const int t : block.torn) {
    const Expression r = define("R(" + name(t) + ")", residual_of(t));
    std::vector<Expression> slope;
    for (std::size_t j = 0; j < m; ++j) {
      slope.push_back(
          define("d(" + name(t) + ")/d(" + name(block.unknowns[j]) + ")", slope_of_row(t, j)));
    }
    lacking[t] = -r;
    slopes[t] = std::move(slope);
    members.push_back(t);
  }
  std::vector<Expression> residual;
  std::vector<std::vector<Expression>> matrix;
  for (std::size_t i = 0; i < m; ++i) {
    const int x = block.unknowns[i];
    residual.push_back(define("R(" + name(x) + ")", residual_of(x)));
    auto& line = matrix.emplace_back();
    for (std::size_t j = 0; j < m; ++j) {
      line.push_back(define("R(" + name(x) + "," + name(block.unknowns[j]) + ")",
                            Expression(i == j ? 1 : 0) - slope_of_row(x, j)));
    }
  }
  std::map<int, Expression> moved;
  const std::vector<Expression> delta = increments(block, residual, matrix, &solve);
  for (std::size_t j = 0; j < m; ++j) moved[block.unknowns[j]] = delta[j];
  for (const int t : block.torn) {
    Expression sum = lacking.at(t);
    for (std::size_t j = 0; j < m; ++j) sum += slopes.at(t)[j] * delta[j];
    moved[t] = define("delta(" + name(t) + ")", sum);
  }
  for (std::size_t j = 0; m <= 3 && j < all.size(); ++j) {
    claim("Newton's increment of " + name(all[j]), solve.variables.at(j).correction,
          moved.at(all[j]));
  }
  for (const int k : evaluated) {
    Expression sum(0);
    for (const int v : all) sum += second(k, v) * moved.at(v);
    correct_gradient(k, sum);
  }
  for (const int v : all) {
    bar_[at(v)] = define("bar(" + name(v) + ")*", bar_[at(v)] + moved.at(v));
  }
}

void ExpectedStep::correct_gradient(int k, const Expression& sum) {
  if (sum.is_zero()) return;
  const Expression change = define("change(H(" + name(k) + "))", sum);
  change_[k] = {*gradient_[at(k)], change};
  gradient_[at(k)] = define("H(" + name(k) + ")*", *gradient_[at(k)] + change);
}

bool ExpectedStep::is_linear_in(int k, const std::set<int>& variables) const {
  bool any = false;
  for (int v = 0; v < 2 * n_; ++v) {
    const Expression slope = derivatives_.second(k, v);
    if (slope.is_zero()) continue;
    if (!variables.contains(v)) return false;
    const std::set<std::string> used = symbols(slope);
    for (const Quantity& variable : mechanics_.variables) {
      if (used.contains(variable.name)) return false;
    }
    any = true;
  }
  return any;
}

std::vector<Expression> ExpectedStep::increments(const Block& block,
                                                 const std::vector<Expression>& residual,
                                                 const std::vector<std::vector<Expression>>& matrix,
                                                 const Solve* solve) {
  const std::size_t m = residual.size();
  std::vector<Expression> delta;
  if (m <= 3) {
    const auto inverse = by_adjugate(block, matrix);
    for (std::size_t i = 0; i < m; ++i) {
      Expression sum(0);
      for (std::size_t j = 0; j < m; ++j) sum += inverse[i][j] * residual[j];
      delta.push_back(define("delta(" + name(block.unknowns[i]) + ")", -sum));
    }
    return delta;
  }
  for (std::size_t i = 0; i < m; ++i) {
    const std::string& x = name(block.unknowns[i]);
    claim("the residual of " + x, solve->residual.at(i), residual[i]);
    for (std::size_t j = 0; j < m; ++j) {
      claim("the derivative of the residual of " + x + " by " + name(block.unknowns[j]),
            solve->matrix.at(i).at(j), matrix[i][j]);
    }
    delta.push_back(Expression::symbol(solve->corrections.at(i)));
  }
  return delta;
}

// R'^-1 by the adjugate.
std::vector<std::vector<Expression>> ExpectedStep::by_adjugate(
    const Block& block, const std::vector<std::vector<Expression>>& a) {
  const std::size_t m = a.size();
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
  const Expression reciprocal = define("1/det(" + name(block.unknowns[0]) + ")",
                                       Expression::power(determinant, Expression(-1)));
  std::vector<std::vector<Expression>> inverse(m, std::vector<Expression>(m));
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < m; ++j) inverse[i][j] = cofactor(j, i) * reciprocal;
  }
  return inverse;
}

}  // namespace hamgen
