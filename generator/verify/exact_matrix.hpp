// Small square matrices of rationals.
#pragma once

#include <vector>

#include "generator/verify/real_roots.hpp"

namespace hamgen {

struct ExactMatrix {
  std::size_t size = 0;
  std::vector<Rational> entries = {};  // row by row

  [[nodiscard]] static ExactMatrix zero(std::size_t size);
  [[nodiscard]] static ExactMatrix identity(std::size_t size);
  [[nodiscard]] const Rational& operator()(std::size_t i, std::size_t j) const {
    return entries[i * size + j];
  }
  [[nodiscard]] Rational& operator()(std::size_t i, std::size_t j) { return entries[i * size + j]; }
};

[[nodiscard]] ExactMatrix operator+(ExactMatrix a, const ExactMatrix& b);
[[nodiscard]] ExactMatrix operator-(ExactMatrix a, const ExactMatrix& b);
[[nodiscard]] ExactMatrix operator*(const Rational& c, ExactMatrix a);
[[nodiscard]] ExactMatrix operator*(const ExactMatrix& a, const ExactMatrix& b);

[[nodiscard]] std::size_t rank(ExactMatrix a);
[[nodiscard]] Rational determinant(const ExactMatrix& a);
// a^-1 b; a matrix of size 0 where a is singular.
[[nodiscard]] ExactMatrix solved(ExactMatrix a, ExactMatrix b);
// det(x - a): its coefficient of x^size is 1.
[[nodiscard]] RationalPolynomial characteristic_polynomial(const ExactMatrix& a);
[[nodiscard]] ExactMatrix value_at(const RationalPolynomial& p, const ExactMatrix& a);

}  // namespace hamgen
