// Blocks solved by Newton's iteration, with the torn variables eliminated from its linear system.
#include <algorithm>

#include "generator/program/step_builder.hpp"

namespace hamgen {

void StepBuilder::evaluate_gradient(NewtonBlock& newton, int k) {
  if (known_gradient_[index(k)]) return;
  newton.evaluated.push_back(k);
  define_gradient(k, newton.where);
}

Expression StepBuilder::second_derivative(NewtonBlock& newton, int k, int v) {
  const Expression plain = equations_.hessian_symbol(k, v);
  if (plain.is_zero()) return plain;
  if (const auto it = newton.hessian.find(plain.name()); it != newton.hessian.end()) {
    return it->second;
  }
  std::string name = plain.name();
  while (!hessian_names_.insert(name).second) name += "*";
  const Expression symbol = Expression::symbol(name, plain.rank());
  define(symbol, at_stage(equations_.stage_hessian(k, v)), newton.where);
  newton.hessian.emplace(plain.name(), symbol);
  return symbol;
}

// d(t)/d(x): named, because it is used for every row.
Expression StepBuilder::name_slope(int t, int x, const Expression& value, int section) {
  if (value.is_number()) return value;
  const Expression symbol =
      Expression::symbol("d(" + name_of(t) + ")/d(" + name_of(x) + ")", kRankOfTemporary);
  define(symbol, value, section);
  return symbol;
}

Expression StepBuilder::increment_symbol(int x) const {
  return Expression::symbol("delta(" + name_of(x) + ")", kRankOfTemporary);
}

NewtonBlock newton_block(const Block& block) {
  NewtonBlock newton{.block = block, .members = block.unknowns};
  const std::size_t m = block.unknowns.size();
  for (std::size_t j = 0; j < m; ++j) {
    std::vector<Expression> unit(m, Expression(0));
    unit[j] = Expression(1);
    newton.slopes[block.unknowns[j]] = std::move(unit);
  }
  return newton;
}

// Newton's iteration on the unknowns, with the torn variables eliminated by the chain rule.  The
// last increment also corrects the gradient to first order, so that no evaluation at the solution
// is needed: the error is quadratic in that increment, as Newton's own.  An affine block differs by
// its matrix, which is inverted once per run where it is constant.
void StepBuilder::add_newton(const Block& block) {
  PendingSolve pending;
  pending.solve.kind = BlockKind::newton;
  pending.solve.linear_solver = linear_solver(block);
  pending.solve.constant_matrix = block.kind == BlockKind::linear && block.constant_matrix;
  const bool written_out = pending.solve.linear_solver == LinearSolver::written_out;
  open_solve();
  sums_exactly_ = true;
  pending.stage = stage_;
  NewtonBlock newton = newton_block(block);
  newton.where = body(stage_);
  newton.outside = after(stage_);

  for (const int x : block.unknowns) {
    lowering_.declare(stage_value_[index(x)].name(), newton.where);
  }
  for (const int t : block.torn) tear_out(newton, t);
  for (const int x : block.unknowns) {
    for (const int k : equations_.row_gradients(x)) evaluate_gradient(newton, k);
  }
  find_off(newton);
  for (const int x : block.unknowns) {
    newton.residual.push_back(lack_of(newton, x));
    add_matrix_row(newton, x);
  }
  solve_linear_system(newton, pending);
  for (std::size_t j = 0; j < block.unknowns.size(); ++j) {
    const int x = block.unknowns[j];
    const bool by_torn =
        std::ranges::find(block.torn, x < n_ ? x + n_ : x - n_) != block.torn.end();
    pending.solve.variables.push_back({stage_value_[index(x)].name(), {}, {}, {}, by_torn});
    begin_with_state(pending, x);
    if (written_out) {
      pending.correction.push_back(lowering_.want(newton.increments[j], newton.where));
    }
  }
  solves_.push_back(std::move(pending));
  correct_solution(newton);
}

// d(bar_x - row x)/d(unknown j)
void StepBuilder::add_matrix_row(NewtonBlock& newton, int x) {
  auto& line = newton.matrix.emplace_back();
  for (std::size_t j = 0; j < newton.block.unknowns.size(); ++j) {
    const auto slope = [&](int v) { return newton.slopes.at(v)[j]; };
    line.push_back(Expression(newton.block.unknowns[j] == x ? 1 : 0) - chain(newton, x, slope));
  }
}

// Row t gives its variable, and the chain rule what it depends on.
void StepBuilder::tear_out(NewtonBlock& newton, int t) {
  tear_value(newton, t);
  tear_slopes(newton, t);
  for (const int k : equations_.row_gradients(t)) evaluate_gradient(newton, k);
}

Expression StepBuilder::own_slope(int t) const {
  Expression slope(1);
  if (!equations_.depends(t, t)) return slope;
  for (const int k : equations_.row_gradients(t)) {
    slope += -(weight(t, k) * at_stage(equations_.stage_hessian(k, t)));
  }
  return slope;
}

void StepBuilder::tear_value(NewtonBlock& newton, int t) {
  if (!equations_.depends(t, t)) {
    for (const int k : equations_.row_gradients(t)) evaluate_gradient(newton, k);
    define(stage_value_[index(t)], row(t, newton.where), newton.where);
    return;
  }
  // Affine in itself: solved for, and then for what its row lacks there, as in Note [affine
  // blocks].
  const Substitution zero{{equations_.stage(t).name(), Expression(0)}};
  std::vector<Expression> terms{carry_symbol(t)};
  for (const int k : equations_.row_gradients(t)) {
    terms.push_back(weight(t, k) * at_stage(substitute(equations_.stage_gradient(k), zero)));
  }
  const Expression known = equations_.mechanics.variable(t) +
                           named_rest(name_of(t), Expression::sum(std::move(terms)), newton.where);
  const Expression first =
      name_value("first(" + name_of(t) + ")", known / own_slope(t), newton.where);
  const std::vector<Expression> gradient = gradient_;
  const Expression stage = stage_value_[index(t)];
  for (const int k : equations_.row_gradients(t)) {
    if (equations_.stage_hessian(k, t).is_zero()) {
      evaluate_gradient(newton, k);
      continue;
    }
    stage_value_[index(t)] = first;
    const Expression value = at_stage(equations_.stage_gradient(k));
    stage_value_[index(t)] = stage;
    const std::string name = gradient_[index(k)].name() + " at first(" + name_of(t) + ")";
    gradient_[index(k)] = name_once(name, value, newton.where);
  }
  const Expression lack = lacking(t, first, newton.where);
  for (const int k : equations_.row_gradients(t)) gradient_[index(k)] = gradient[index(k)];
  define(stage, first - lack / own_slope(t), newton.where);
}

void StepBuilder::tear_slopes(NewtonBlock& newton, int t) {
  std::vector<Expression> slopes;
  for (std::size_t j = 0; j < newton.block.unknowns.size(); ++j) {
    const Expression value =
        chain(newton, t, [&](int v) { return newton.slopes.at(v)[j]; }) / own_slope(t);
    slopes.push_back(name_slope(t, newton.block.unknowns[j], value, newton.where));
  }
  newton.slopes[t] = std::move(slopes);
  newton.members.push_back(t);
}

// Everything that was evaluated before the last increment, corrected by it.
//
// Note [a step moves by what its equations were solved with]
// What the last increment adds to a gradient stands beside it, and each moves z by h times itself.
// A momentum that takes it in, a sum of the size of p, is rounded once more: then z moves by
// another number than the one with which the equations hold.  At small steps h makes that harmless;
// at h = 1 the form of a chain of 6 drifts by 3e-3 units of rounding a step, and less than 1e-4
// this way.
void StepBuilder::correct_solution(NewtonBlock& newton) {
  const Block& block = newton.block;
  std::map<int, Expression> moved;
  for (const int v : newton.members) {
    std::vector<Expression> terms;
    for (std::size_t j = 0; j < block.unknowns.size(); ++j) {
      terms.push_back(newton.slopes.at(v)[j] * newton.increments[j]);
    }
    if (const auto off = newton.off.find(v); off != newton.off.end()) terms.push_back(off->second);
    moved[v] = Expression::sum(std::move(terms));
  }
  const auto correct = [&](int k) {
    std::vector<Expression> terms;
    for (const int v : newton.members) {
      terms.push_back(second_derivative(newton, k, v) * moved[v]);
    }
    correct_gradient(k, Expression::sum(std::move(terms)), newton.outside);
  };
  // Forces first: what they change by is at hand for the momenta that are torn out.
  const auto is_force = [&](int k) {
    return std::ranges::none_of(block.torn,
                                [&](int t) { return !second_derivative(newton, k, t).is_zero(); });
  };
  for (const int k : newton.evaluated) {
    if (is_force(k)) correct(k);
  }
  for (const int t : block.torn) {
    const std::vector<int> gradients = equations_.row_gradients(t);
    if (solves_constants_ || !std::ranges::all_of(gradients, is_force)) continue;
    std::vector<Expression> terms;
    for (const int k : gradients) {
      // Of an earlier block the row has it in the gradient itself.
      const bool is_ours = std::ranges::find(newton.evaluated, k) != newton.evaluated.end();
      if (is_ours) terms.push_back(weight(t, k) * correction_[index(k)].second);
    }
    moved[t] = Expression::sum(std::move(terms));
  }
  for (const int k : newton.evaluated) {
    if (!is_force(k)) correct(k);
  }
  for (const int v : newton.members) {
    renew(stage_value_[index(v)], equations_.stage(v).name(), stage_value_[index(v)] + moved[v],
          newton.outside);
  }
}

// dH/dz_k as the last iteration evaluated it, and what the last increment adds.
void StepBuilder::correct_gradient(int k, const Expression& change, int section) {
  if (change.is_zero()) return;
  const Expression main = gradient_[index(k)];
  const Expression symbol = Expression::symbol("change(" + main.name() + ")", kRankOfTemporary);
  define(symbol, change, section);
  correction_[index(k)] = {main, symbol};
  renew(gradient_[index(k)], main.name(), main + symbol, section);
}

// Newton's iteration with the Hessian of a shorter K.  The torn unknowns are eliminated from the
// linear system only: delta_t = r_t + sum_j slope_tj delta_j, where r_t is what their rows lack
// now.  The last increment corrects the gradient with the same Hessian, whose error times that
// increment is as small as the next increment, which the stopping rule bounds.
void StepBuilder::add_simplified_newton(const Block& block) {
  open_solve();
  PendingSolve pending{.solve = {}, .stage = stage_};
  pending.solve.kind = BlockKind::newton;
  pending.solve.simplified = true;
  pending.solve.linear_solver = linear_solver(block);
  NewtonBlock newton = newton_block(block);
  newton.where = body(stage_);
  newton.outside = after(stage_);
  const std::size_t m = block.unknowns.size();

  std::vector<int> all = block.unknowns;
  all.insert(all.end(), block.torn.begin(), block.torn.end());
  for (const int v : all) lowering_.declare(stage_value_[index(v)].name(), newton.where);
  for (const int v : all) {
    for (const int k : equations_.row_gradients(v)) evaluate_gradient(newton, k);
  }
  // delta_v = missing.at(v) + sum_j slopes.at(v)[j] delta_j of the members known so far.
  std::map<int, Expression> missing;
  const auto residual = [&](int i) {
    return stage_value_[index(i)] - row(i, newton.where) -
           chain(newton, i, [&](int v) { return missing[v]; });
  };
  for (const int t : block.torn) {
    const Expression symbol = Expression::symbol("R(" + name_of(t) + ")", kRankOfTemporary + t);
    define(symbol, residual(t), newton.where);
    std::vector<Expression> slopes;
    for (std::size_t j = 0; j < m; ++j) {
      slopes.push_back(name_slope(t, block.unknowns[j],
                                  chain(newton, t, [&](int v) { return newton.slopes.at(v)[j]; }),
                                  newton.where));
    }
    missing[t] = -symbol;
    newton.slopes[t] = std::move(slopes);
    newton.members.push_back(t);
  }
  for (std::size_t i = 0; i < m; ++i) {
    newton.residual.push_back(residual(block.unknowns[i]));
    std::vector<Expression> line;
    for (std::size_t j = 0; j < m; ++j) {
      const auto slope = [&](int v) { return newton.slopes.at(v)[j]; };
      line.push_back(Expression(i == j ? 1 : 0) - chain(newton, block.unknowns[i], slope));
    }
    newton.matrix.push_back(std::move(line));
  }
  solve_linear_system(newton, pending);

  std::map<int, Expression> increments;
  for (std::size_t j = 0; j < m; ++j) increments[block.unknowns[j]] = newton.increments[j];
  for (const int t : block.torn) {
    std::vector<Expression> terms{missing[t]};
    for (std::size_t j = 0; j < m; ++j) {
      terms.push_back(newton.slopes.at(t)[j] * newton.increments[j]);
    }
    increments[t] = increment_symbol(t);
    define(increments[t], Expression::sum(std::move(terms)), newton.where);
  }
  for (const int v : newton.members) {
    pending.solve.variables.push_back({stage_value_[index(v)].name(), {}, {}, {}});
    begin_with_state(pending, v);
    if (pending.solve.corrections.empty()) {
      pending.correction.push_back(lowering_.want(increments[v], newton.where));
    }
  }
  solves_.push_back(std::move(pending));

  for (const int k : newton.evaluated) {
    std::vector<Expression> terms;
    for (const int v : newton.members) {
      terms.push_back(second_derivative(newton, k, v) * increments[v]);
    }
    correct_gradient(k, Expression::sum(std::move(terms)), newton.outside);
  }
  for (const int v : newton.members) {
    renew(stage_value_[index(v)], equations_.stage(v).name(),
          stage_value_[index(v)] + increments[v], newton.outside);
  }
}

}  // namespace hamgen
