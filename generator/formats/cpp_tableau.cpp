// The numbers of an implicit Runge-Kutta method in C++.
#include "generator/formats/cpp_tableau.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

using Rows = std::vector<std::vector<Rational>>;
using Row = std::vector<Rational>;

Row values_of(const std::vector<Expression>& row) {
  Row values;
  for (const Expression& e : row) values.push_back(numeric_value(e));
  return values;
}

// Multiplies a polynomial, coefficients of 1, x, ..., by (x - node) / width.
Row times_linear(const Row& polynomial, const Rational& node, const Rational& width) {
  Row result(polynomial.size() + 1);
  for (std::size_t k = 0; k < polynomial.size(); ++k) {
    result[k] -= polynomial[k] * node / width;
    result[k + 1] += polynomial[k] / width;
  }
  return result;
}

// Integral from 1 to x.
Rational integral_from_one(const Row& polynomial, const Rational& x) {
  Rational sum(0);
  Rational power(1);
  for (std::size_t k = 0; k < polynomial.size(); ++k) {
    power *= x;
    sum += polynomial[k] * (power - 1) / Rational(static_cast<long>(k) + 1);
  }
  return sum;
}

// Row i: with the polynomial that has the slopes f_j at the nodes c_j of the last step, the
// increment from its end to the node 1 + c_i, per L_j = h b_j f_j.
Rows extrapolation(const Row& b, const Row& c) {
  const std::size_t s = b.size();
  Rows result(s, Row(s));
  for (std::size_t j = 0; j < s; ++j) {
    Row lagrange{Rational(1)};
    for (std::size_t k = 0; k < s; ++k) {
      if (k != j) lagrange = times_linear(lagrange, c[k], c[j] - c[k]);
    }
    for (std::size_t i = 0; i < s; ++i) {
      result[i][j] = integral_from_one(lagrange, 1 + c[i]) / b[j];
    }
  }
  return result;
}

void write_matrix_of(CodeWriter& out, const std::string& name,
                     const std::vector<std::vector<std::string>>& rows) {
  out.line(fmt::format("inline constexpr Real {}[stages][stages] = {{", name));
  for (const auto& row : rows) {
    std::string line = "    {";
    for (std::size_t j = 0; j < row.size(); ++j) {
      const std::string item = row[j] + (j + 1 < row.size() ? "," : "},");
      if (line.size() + item.size() > 98) {
        out.line(line);
        line = "    ";
      }
      line += (line.ends_with('{') || line == "    " ? "" : " ") + item;
    }
    out.line(line);
  }
  out.line("};");
}

}  // namespace

void write_tableau(CodeWriter& out, const ScalarType& scalar, const StageTable& table,
                   const std::vector<Expression>& nodes) {
  const Row b = values_of(table.weight);
  const Row c = values_of(nodes);
  const std::size_t s = b.size();
  Rows coupling;
  for (const auto& row : table.coupling) coupling.push_back(values_of(row));
  std::vector<std::vector<std::string>> m(s, std::vector<std::string>(s));
  for (std::size_t i = 0; i < s; ++i) {
    m[i][i] = literal(Rational(1, 2), scalar);
    for (std::size_t j = i + 1; j < s; ++j) {
      // The larger one is rounded; 1 minus it then is exact.
      const bool upper = coupling[i][j] >= coupling[j][i];
      std::string& larger = upper ? m[i][j] : m[j][i];
      std::string& smaller = upper ? m[j][i] : m[i][j];
      larger = literal(upper ? coupling[i][j] : coupling[j][i], scalar);
      smaller = "1 - " + larger;
    }
  }
  out.line(fmt::format("inline constexpr int stages = {};", s));
  std::string weights;
  for (const Rational& value : b) weights += (weights.empty() ? "" : ", ") + literal(value, scalar);
  out.line(fmt::format("inline constexpr Real weight[stages] = {{{}}};", weights));
  out.line();
  out.lines(
      R"(// coupling[i][j] = a_ij / b_j: with L_j = h b_j f(Y_j) the stages are Y_i = z + sum coupling[i][j] L_j.
// The step is symplectic because coupling[i][j] + coupling[j][i] = 1.  Written like this the sum is 1
// exactly: rounded coefficients too give a symplectic step, and no drift in the energy.
)");
  write_matrix_of(out, "coupling", m);
  out.line();
  out.line(
      "// From the stages of one step to a start for those of the next, on the same polynomial.");
  std::vector<std::vector<std::string>> ahead;
  for (const Row& row : extrapolation(b, c)) {
    auto& texts = ahead.emplace_back();
    for (const Rational& value : row) texts.push_back(literal(value, scalar));
  }
  write_matrix_of(out, "ahead", ahead);
  out.line();
}

}  // namespace hamgen
