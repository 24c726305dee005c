// An affine block that is written out: its solution from z, and what its equations lack there.
#include "generator/verify/expected_builder.hpp"

namespace hamgen {

void ExpectedStep::affine(const Block& block) {
  const std::size_t m = block.unknowns.size();
  second_.clear();
  std::vector<int> members = block.unknowns;
  std::map<int, std::vector<Expression>> slopes;  // d(member)/d(unknown)
  for (std::size_t j = 0; j < m; ++j) {
    slopes[block.unknowns[j]] = std::vector<Expression>(m, Expression(0));
    slopes[block.unknowns[j]][j] = Expression(1);
  }
  const auto slope_of_row = [&](int i, std::size_t j) {
    return along(i, members, [&](int v) { return slopes.at(v)[j]; });
  };
  std::map<int, Expression> own;  // 1 - d(row t)/d(bar_t)
  for (const int t : block.torn) {
    own[t] = Expression(1);
    for (const auto& [k, weight] : weights_[t]) {
      own[t] += -(weight * at_stage(derivatives_.second(k, t)));
    }
    std::vector<Expression> slope;
    for (std::size_t j = 0; j < m; ++j) {
      slope.push_back(define("d(" + name(t) + ")/d(" + name(block.unknowns[j]) + ")",
                             slope_of_row(t, j) / own[t]));
    }
    slopes[t] = std::move(slope);
    members.push_back(t);
  }
  std::vector<std::vector<Expression>> matrix;
  for (const int x : block.unknowns) {
    auto& line = matrix.emplace_back();
    for (std::size_t j = 0; j < m; ++j) {
      line.push_back(define("R(" + name(x) + "," + name(block.unknowns[j]) + ")",
                            Expression(block.unknowns[j] == x ? 1 : 0) - slope_of_row(x, j)));
    }
  }
  auto inverse = by_adjugate(block, matrix);
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < m; ++j) {
      inverse[i][j] =
          define("inverse(" + name(block.unknowns[i]) + "," + name(block.unknowns[j]) + ")",
                 inverse[i][j]);
    }
  }
  const auto solution = [&](const std::vector<Expression>& right_side, std::size_t i) {
    Expression sum(0);
    for (std::size_t j = 0; j < m; ++j) sum += inverse[i][j] * right_side[j];
    return sum;
  };

  // matrix bar = the rows at bar = 0, without the carry.
  for (const int v : members) bar_[at(v)] = Expression(0);
  const auto row_at_bar = [&](int i) {
    Expression sum = mechanics_.variable(i);
    for (const auto& [k, weight] : weights_[i]) sum += weight * at_stage(derivatives_.first(k));
    return sum;
  };
  for (const int t : block.torn) {
    bar_[at(t)] = define("start(" + name(t) + ")", row_at_bar(t) / own[t]);
  }
  std::vector<Expression> start;
  for (const int x : block.unknowns)
    start.push_back(define("start(" + name(x) + ")", row_at_bar(x)));
  for (std::size_t i = 0; i < m; ++i) {
    bar_[at(block.unknowns[i])] =
        define("bar(" + name(block.unknowns[i]) + ")", solution(start, i));
  }

  std::vector<int> evaluated;
  const auto evaluate_row = [&](int i) {
    for (const auto& [k, weight] : weights_[i]) {
      if (!gradient_[at(k)]) evaluated.push_back(k);
      (void)gradient(k);
    }
  };
  for (const int t : block.torn) {
    if (own[t].is_one()) {
      evaluate_row(t);
      bar_[at(t)] = define("bar(" + name(t) + ")", row(t));
    } else {
      bar_[at(t)] = affine_value(t, own[t]);
      evaluate_row(t);
    }
  }
  std::vector<Expression> residual;
  for (const int x : block.unknowns) {
    evaluate_row(x);
    residual.push_back(define("R(" + name(x) + ")", bar_[at(x)] - row(x)));
  }
  std::vector<Expression> delta;
  for (std::size_t i = 0; i < m; ++i) {
    delta.push_back(define("delta(" + name(block.unknowns[i]) + ")", -solution(residual, i)));
  }
  claim_affine(evaluated, members);
  std::map<int, Expression> moved;
  for (const int v : members) {
    Expression sum(0);
    for (std::size_t j = 0; j < m; ++j) sum += slopes.at(v)[j] * delta[j];
    moved[v] = sum;
  }
  for (const int k : evaluated) {
    Expression sum(0);
    for (const int v : members) sum += second(k, v) * moved[v];
    correct_gradient(k, sum);
  }
  for (const int v : members) {
    bar_[at(v)] = define("bar(" + name(v) + ")*", bar_[at(v)] + moved[v]);
  }
}

void ExpectedStep::claim_affine(const std::vector<int>& components,
                                const std::vector<int>& variables) {
  Substitution zero;
  for (const int v : variables) zero.emplace(mechanics_.variable(v).name(), Expression(0));
  for (const int k : components) {
    Expression affine = substitute(derivatives_.first(k), zero);
    for (const int v : variables) affine += derivatives_.second(k, v) * mechanics_.variable(v);
    claim("dH/d" + name(k) + " is affine where it is taken so", derivatives_.first(k), affine);
  }
}

}  // namespace hamgen
