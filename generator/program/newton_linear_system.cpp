// The linear system of a Newton iteration: written out where it is small, else handed to the format
// as entries.
#include "generator/program/step_builder.hpp"

namespace hamgen {

void StepBuilder::solve_linear_system(NewtonBlock& newton, PendingSolve& pending) {
  Solve& solve = pending.solve;
  for (const int x : newton.block.unknowns) newton.increments.push_back(increment_symbol(x));
  if (solve.linear_solver == LinearSolver::written_out) {
    write_out_solution(newton);
    return;
  }
  for (const Expression& e : newton.residual) {
    pending.residual.push_back(lowering_.want(e, newton.where));
  }
  const int matrix_section = solve.constant_matrix ? kCoefficients : newton.where;
  for (const auto& line : newton.matrix) {
    auto& handles = pending.matrix.emplace_back();
    for (const Expression& e : line) handles.push_back(lowering_.want(e, matrix_section));
  }
  for (const Expression& symbol : newton.increments) {
    solve.corrections.push_back(symbol.name());
    lowering_.declare(symbol.name(), newton.iterates ? newton.where : newton.outside);
  }
}

namespace {

// Of a matrix of size 1, 2 or 3: entry (i, j) of the result is the cofactor of entry (i, j).
std::vector<std::vector<Expression>> cofactors(const std::vector<std::vector<Expression>>& a) {
  const std::size_t m = a.size();
  std::vector<std::vector<Expression>> result(m, std::vector<Expression>(m, Expression(1)));
  for (std::size_t i = 0; i < m && m > 1; ++i) {
    for (std::size_t j = 0; j < m; ++j) {
      if (m == 2) {
        result[i][j] = i == j ? a[1 - i][1 - j] : -a[1 - i][1 - j];
        continue;
      }
      // With cyclic indices they carry their sign.
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      result[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
    }
  }
  return result;
}

}  // namespace

Expression StepBuilder::name_value(const std::string& text, const Expression& value, int section) {
  if (value.is_number()) return value;
  const Expression symbol = Expression::symbol(text, kRankOfTemporary);
  define(symbol, value, section);
  return symbol;
}

std::string StepBuilder::residual_name(const Block& block, std::size_t i) const {
  return "R(" + name_of(block.unknowns[i]);
}

void StepBuilder::name_matrix(NewtonBlock& newton, std::size_t i) {
  for (std::size_t j = 0; j < newton.matrix[i].size(); ++j) {
    Expression& entry = newton.matrix[i][j];
    const std::string& column = name_of(newton.block.unknowns[j]);
    entry = name_value(residual_name(newton.block, i) + "," + column + ")", entry, newton.where);
  }
}

// -matrix^-1 residual by Cramer's rule.
void StepBuilder::write_out_solution(NewtonBlock& newton) {
  const Block& block = newton.block;
  const std::size_t m = newton.residual.size();
  std::vector<Expression> r;
  for (std::size_t i = 0; i < m; ++i) {
    r.push_back(name_value(residual_name(block, i) + ")", newton.residual[i], newton.where));
    name_matrix(newton, i);
  }
  const auto& a = newton.matrix;
  if (m == 1) {
    define(newton.increments[0], -(r[0] * Expression::power(a[0][0], Expression(-1))),
           newton.where);
    return;
  }
  const auto cofactor = cofactors(a);
  Expression determinant(0);
  for (std::size_t j = 0; j < m; ++j) determinant += a[0][j] * cofactor[0][j];
  const Expression inverse =
      name_value("1/det(" + name_of(block.unknowns[0]) + ")",
                 Expression::power(determinant, Expression(-1)), newton.where);
  for (std::size_t j = 0; j < m; ++j) {
    std::vector<Expression> terms;
    for (std::size_t i = 0; i < m; ++i) terms.push_back(cofactor[i][j] * r[i]);
    define(newton.increments[j], -(inverse * Expression::sum(std::move(terms))), newton.where);
  }
}

void StepBuilder::write_out_inverse(NewtonBlock& newton) {
  const Block& block = newton.block;
  const std::size_t m = newton.matrix.size();
  for (std::size_t i = 0; i < m; ++i) name_matrix(newton, i);
  const auto& a = newton.matrix;
  const auto cofactor = cofactors(a);
  Expression determinant(0);
  for (std::size_t j = 0; j < m; ++j) determinant += a[0][j] * cofactor[0][j];
  const Expression reciprocal =
      name_value("1/det(" + name_of(block.unknowns[0]) + ")",
                 Expression::power(determinant, Expression(-1)), newton.where);
  newton.inverse.assign(m, std::vector<Expression>(m));
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < m; ++j) {
      newton.inverse[i][j] = name_value(
          "inverse(" + name_of(block.unknowns[i]) + "," + name_of(block.unknowns[j]) + ")",
          cofactor[j][i] * reciprocal, newton.where);
    }
  }
}

}  // namespace hamgen
