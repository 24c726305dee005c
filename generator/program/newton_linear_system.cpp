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

// -matrix^-1 residual by Cramer's rule, with the inverse named when it is constant.
void StepBuilder::write_out_solution(NewtonBlock& newton) {
  const Block& block = newton.block;
  const std::size_t m = newton.residual.size();
  auto name = [&](const std::string& what, std::size_t i) {
    return what + "(" + name_of(block.unknowns[i]);
  };
  auto named = [&](const std::string& text, const Expression& value) {
    if (value.is_number()) return value;
    const Expression symbol = Expression::symbol(text, kRankOfTemporary);
    define(symbol, value, newton.where);
    return symbol;
  };
  std::vector<Expression> r;
  std::vector<std::vector<Expression>> a(m, std::vector<Expression>(m));
  for (std::size_t i = 0; i < m; ++i) {
    r.push_back(named(name("R", i) + ")", newton.residual[i]));
    for (std::size_t j = 0; j < m; ++j) {
      const std::string column = name_of(block.unknowns[j]);
      a[i][j] = named(name("R", i) + "," + column + ")", newton.matrix[i][j]);
    }
  }
  if (m == 1) {
    // A constant slope is inverted once per run.
    define(newton.increments[0], -(r[0] * Expression::power(a[0][0], Expression(-1))),
           newton.where);
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
    define(newton.increments[j], -(inverse * Expression::sum(std::move(terms))), newton.where);
  }
}

}  // namespace hamgen
