// The equations of a step as numbers, and elimination.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace hamgen::contract {

__extension__ typedef __float128 Quad;
using Vector = std::vector<Quad>;
using Matrix = std::vector<Vector>;

inline Quad magnitude(Quad x) { return x < 0 ? -x : x; }
inline Quad larger(Quad x, Quad y) { return x < y ? y : x; }

template <class Real>
std::vector<std::vector<Real>> unit(std::size_t size) {
  std::vector<std::vector<Real>> result(size, std::vector<Real>(size));
  for (std::size_t i = 0; i < size; ++i) result[i][i] = 1;
  return result;
}

// x of A x = v by elimination with partial pivoting, and A^-1 from the columns of a unit matrix;
// false if A is singular.
template <class Real>
bool solve(std::vector<std::vector<Real>> a, std::vector<std::vector<Real>>& v) {
  const auto size = [](Real x) { return x < 0 ? -x : x; };
  const std::size_t m = a.size();
  for (std::size_t c = 0; c < m; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < m; ++r) {
      if (size(a[r][c]) > size(a[pivot][c])) pivot = r;
    }
    if (!(size(a[pivot][c]) > 0)) return false;
    std::swap(a[c], a[pivot]);
    std::swap(v[c], v[pivot]);
    for (std::size_t r = 0; r < m; ++r) {
      if (r == c || a[r][c] == 0) continue;
      const Real factor = a[r][c] / a[c][c];
      for (std::size_t j = c; j < m; ++j) a[r][j] -= factor * a[c][j];
      for (std::size_t j = 0; j < v[r].size(); ++j) v[r][j] -= factor * v[c][j];
    }
  }
  for (std::size_t r = 0; r < m; ++r) {
    for (Real& value : v[r]) value /= a[r][r];
  }
  return true;
}

// Y_i = z + h sum_j a_ij J grad H(Y_j),  Z = z + h sum_j b_j J grad H(Y_j):  a_ij is one number, or
// of a member (s = 1, b = 1) the matrix I/2 + C.
struct Equations {
  Vector b;          // s; empty for an explicit method, which has no equations
  Matrix a = {};     // s x s, of a Runge-Kutta method
  Vector d = {};     // |b^T a^-1|, of a Runge-Kutta method
  Matrix c = {};     // 2n x 2n, I/2 + C of a member
  Matrix back = {};  // |(I/2 + C)^-1|/2, empty where there is none
  [[nodiscard]] std::size_t stages() const { return b.size(); }
  [[nodiscard]] bool is_member() const { return !c.empty(); }
};

// With I/2 + C.
inline Equations member(Matrix c) {
  Equations e{.b = {1}};
  e.back = unit<Quad>(c.size());
  if (solve(c, e.back)) {
    for (Vector& row : e.back) {
      for (Quad& entry : row) entry = magnitude(entry) / 2;
    }
  } else {
    e.back.clear();
  }
  e.c = std::move(c);
  return e;
}

inline Equations runge_kutta(Matrix a, Vector b) {
  const std::size_t s = b.size();
  Matrix transposed(s, Vector(s));
  Matrix right(s, Vector(1));
  for (std::size_t i = 0; i < s; ++i) {
    right[i][0] = b[i];
    for (std::size_t j = 0; j < s; ++j) transposed[j][i] = a[i][j];
  }
  if (!solve(transposed, right)) return {};
  Equations e{.b = std::move(b), .a = std::move(a)};
  for (std::size_t i = 0; i < s; ++i) e.d.push_back(magnitude(right[i][0]));
  return e;
}

}  // namespace hamgen::contract
