#include "generator/verify/exact_matrix.hpp"

#include <utility>

namespace hamgen {

ExactMatrix ExactMatrix::zero(std::size_t size) {
  return {size, std::vector<Rational>(size * size)};
}

ExactMatrix ExactMatrix::identity(std::size_t size) {
  ExactMatrix result = zero(size);
  for (std::size_t i = 0; i < size; ++i) result(i, i) = 1;
  return result;
}

ExactMatrix operator+(ExactMatrix a, const ExactMatrix& b) {
  for (std::size_t k = 0; k < a.entries.size(); ++k) a.entries[k] += b.entries[k];
  return a;
}

ExactMatrix operator-(ExactMatrix a, const ExactMatrix& b) {
  for (std::size_t k = 0; k < a.entries.size(); ++k) a.entries[k] -= b.entries[k];
  return a;
}

ExactMatrix operator*(const Rational& c, ExactMatrix a) {
  for (Rational& x : a.entries) x *= c;
  return a;
}

ExactMatrix operator*(const ExactMatrix& a, const ExactMatrix& b) {
  ExactMatrix result = ExactMatrix::zero(a.size);
  for (std::size_t i = 0; i < a.size; ++i) {
    for (std::size_t k = 0; k < a.size; ++k) {
      if (a(i, k) == 0) continue;
      for (std::size_t j = 0; j < a.size; ++j) result(i, j) += a(i, k) * b(k, j);
    }
  }
  return result;
}

namespace {

// Gauss's elimination of [a | b]; the rank of a.  With `fully` the rows above the pivots as well.
std::size_t eliminate(ExactMatrix& a, ExactMatrix* b) {
  const std::size_t n = a.size;
  std::size_t row = 0;
  for (std::size_t column = 0; column < n && row < n; ++column) {
    std::size_t pivot = row;
    while (pivot < n && a(pivot, column) == 0) ++pivot;
    if (pivot == n) continue;
    const auto for_rows = [&](auto use) {
      use(a);
      if (b != nullptr) use(*b);
    };
    for_rows([&](ExactMatrix& m) {
      for (std::size_t j = 0; j < n; ++j) std::swap(m(pivot, j), m(row, j));
    });
    const Rational inverse = 1 / a(row, column);
    for_rows([&](ExactMatrix& m) {
      for (std::size_t j = 0; j < n; ++j) m(row, j) *= inverse;
    });
    for (std::size_t i = 0; i < n; ++i) {
      const Rational factor = a(i, column);
      if (i == row || factor == 0) continue;
      for_rows([&](ExactMatrix& m) {
        for (std::size_t j = 0; j < n; ++j) m(i, j) -= factor * m(row, j);
      });
    }
    ++row;
  }
  return row;
}

}  // namespace

std::size_t rank(ExactMatrix a) { return eliminate(a, nullptr); }

ExactMatrix solved(ExactMatrix a, ExactMatrix b) {
  return eliminate(a, &b) == a.size ? b : ExactMatrix{};
}

// Faddeev and LeVerrier: M_1 = I, c_(n-k) = -tr(a M_k)/k, M_(k+1) = a M_k + c_(n-k) I.
RationalPolynomial characteristic_polynomial(const ExactMatrix& a) {
  RationalPolynomial p(a.size + 1);
  p[a.size] = 1;
  ExactMatrix m = ExactMatrix::identity(a.size);
  for (std::size_t k = 1; k <= a.size; ++k) {
    m = a * m;
    Rational trace = 0;
    for (std::size_t i = 0; i < a.size; ++i) trace += m(i, i);
    p[a.size - k] = -trace / static_cast<unsigned long>(k);
    for (std::size_t i = 0; i < a.size; ++i) m(i, i) += p[a.size - k];
  }
  return p;
}

Rational determinant(const ExactMatrix& a) {
  const Rational constant = characteristic_polynomial(a).front();
  return a.size % 2 == 0 ? constant : Rational(-constant);
}

ExactMatrix value_at(const RationalPolynomial& p, const ExactMatrix& a) {
  ExactMatrix result = ExactMatrix::zero(a.size);
  for (std::size_t k = p.size(); k-- > 0;) {
    result = result * a;
    for (std::size_t i = 0; i < a.size; ++i) result(i, i) += p[k];
  }
  return result;
}

}  // namespace hamgen
