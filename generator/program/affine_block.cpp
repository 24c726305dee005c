// Blocks that are affine in their unknowns and small enough to be written out: no iteration.
#include "generator/program/step_builder.hpp"

namespace hamgen {

namespace {

Expression product(const std::vector<Expression>& row, const std::vector<Expression>& vector) {
  std::vector<Expression> terms;
  for (std::size_t j = 0; j < row.size(); ++j) terms.push_back(row[j] * vector[j]);
  return Expression::sum(std::move(terms));
}

}  // namespace

// See Note [affine blocks].  Derivatives are free of the unknowns, and come first.
void StepBuilder::add_affine(const Block& block) {
  sums_exactly_ = true;
  NewtonBlock newton = newton_block(block);
  newton.iterates = false;
  newton.where = straight();
  newton.outside = straight();
  for (const int t : block.torn) tear_slopes(newton, t);
  for (const int x : block.unknowns) add_matrix_row(newton, x);
  write_out_inverse(newton);
  start_affine(newton);

  for (const int t : block.torn) {
    tear_value(newton, t);
    for (const int k : equations_.row_gradients(t)) evaluate_gradient(newton, k);
  }
  for (const int x : block.unknowns) {
    for (const int k : equations_.row_gradients(x)) evaluate_gradient(newton, k);
  }
  find_off(newton);
  std::vector<Expression> lack;
  for (std::size_t i = 0; i < block.unknowns.size(); ++i) {
    lack.push_back(name_value(residual_name(block, i) + ")", lack_of(newton, block.unknowns[i]),
                              newton.where));
  }
  for (std::size_t i = 0; i < lack.size(); ++i) {
    newton.increments.push_back(increment_symbol(block.unknowns[i]));
    define(newton.increments[i], -product(newton.inverse[i], lack), newton.where);
  }
  correct_solution(newton);
  if (block.constant_matrix) multiply_out(newton, lack);
}

// How far what is torn out is from its rows with a constant matrix, for its sum was rounded.
void StepBuilder::find_off(NewtonBlock& newton) {
  if (!solves_constants_) return;
  for (const int t : newton.block.torn) {
    const Expression lack = name_value("R(" + name_of(t) + ")", lack_of(newton, t), newton.where);
    newton.off[t] = name_value("off(" + name_of(t) + ")", -(lack / own_slope(t)), newton.where);
  }
}

// What row i lacks where all that is torn out is at the solution of its own.
Expression StepBuilder::lack_of(NewtonBlock& newton, int i) {
  const Expression lack = lacking(i, stage_value_[index(i)], newton.where);
  return lack - chain(newton, i, [&](int v) {
           const auto off = newton.off.find(v);
           return off == newton.off.end() ? Expression(0) : off->second;
         });
}

// The corrections of the gradient by what the equations lack, their factors constant.
void StepBuilder::multiply_out(NewtonBlock& newton, const std::vector<Expression>& lack) {
  for (const int k : newton.evaluated) {
    if (correction_[index(k)].second.is_zero()) continue;
    std::vector<Expression> terms;
    for (std::size_t i = 0; i < lack.size(); ++i) {
      std::vector<Expression> factor;
      for (const int v : newton.members) {
        const Expression slope = second_derivative(newton, k, v);
        for (std::size_t j = 0; j < lack.size(); ++j) {
          factor.push_back(-(slope * newton.slopes.at(v)[j] * newton.inverse[j][i]));
        }
      }
      terms.push_back(Expression::sum(std::move(factor)) * lack[i]);
    }
    for (const auto& [t, off] : newton.off) terms.push_back(second_derivative(newton, k, t) * off);
    correction_[index(k)].second = Expression::sum(std::move(terms));
  }
}

// matrix zbar = b with b the rows at zbar = 0, from z without the carry: good to rounding.
void StepBuilder::start_affine(NewtonBlock& newton) {
  const Block& block = newton.block;
  const std::vector<Expression> stage_values = stage_value_;
  for (const int x : block.unknowns) stage_value_[index(x)] = Expression(0);
  const auto row_at_zero = [&](int i) {
    std::vector<Expression> terms{equations_.mechanics.variable(i)};
    for (const int k : equations_.row_gradients(i)) {
      terms.push_back(weight(i, k) * at_stage(equations_.stage_gradient(k)));
    }
    return Expression::sum(std::move(terms));
  };
  for (const int t : block.torn) {
    stage_value_[index(t)] = Expression(0);
    stage_value_[index(t)] =
        name_value("start(" + name_of(t) + ")", row_at_zero(t) / own_slope(t), newton.where);
  }
  std::vector<Expression> b;
  for (const int x : block.unknowns) {
    b.push_back(name_value("start(" + name_of(x) + ")", row_at_zero(x), newton.where));
  }
  stage_value_ = stage_values;
  for (std::size_t i = 0; i < b.size(); ++i) {
    define(stage_value_[index(block.unknowns[i])], product(newton.inverse[i], b), newton.where);
  }
}

}  // namespace hamgen
