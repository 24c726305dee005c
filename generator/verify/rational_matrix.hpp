// Small square matrices of rationals.
#pragma once

#include <vector>

#include "generator/verify/real_roots.hpp"

namespace hamgen {

struct RationalMatrix {
  std::size_t size = 0;
  std::vector<Rational> entries = {};  // row by row

  [[nodiscard]] static RationalMatrix zero(std::size_t size);
  [[nodiscard]] static RationalMatrix identity(std::size_t size);
  [[nodiscard]] const Rational& operator()(std::size_t i, std::size_t j) const {
    return entries[i * size + j];
  }
  [[nodiscard]] Rational& operator()(std::size_t i, std::size_t j) { return entries[i * size + j]; }
};

[[nodiscard]] RationalMatrix operator+(RationalMatrix a, const RationalMatrix& b);
[[nodiscard]] RationalMatrix operator-(RationalMatrix a, const RationalMatrix& b);
[[nodiscard]] RationalMatrix operator*(const Rational& c, RationalMatrix a);
[[nodiscard]] RationalMatrix operator*(const RationalMatrix& a, const RationalMatrix& b);

[[nodiscard]] std::size_t rank(RationalMatrix a);
[[nodiscard]] Rational determinant(const RationalMatrix& a);
// a^-1 b; a matrix of size 0 where a is singular.
[[nodiscard]] RationalMatrix solved(RationalMatrix a, RationalMatrix b);
// det(x - a): its coefficient of x^size is 1.
[[nodiscard]] RationalPolynomial characteristic_polynomial(const RationalMatrix& a);
[[nodiscard]] RationalMatrix value_at(const RationalPolynomial& p, const RationalMatrix& a);

}  // namespace hamgen
