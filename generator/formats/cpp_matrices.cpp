// The matrices of large systems.
#include <fmt/format.h>

#include "generator/formats/cpp_arrays.hpp"

namespace hamgen {

void write_band_matrix(CodeWriter& out, int width) {
  out.line(fmt::format(
      "// A matrix whose entries lie within {} of the diagonal: elimination with partial", width));
  out.line(
      "// pivoting, which fills as many diagonals again above it.  Row i holds columns i - width "
      "on.");
  out.open("class BandMatrix");
  out.dedent();
  out.lines(fmt::format(R"( public:
  void clear() {{
    for (auto& row : entry_) {{
      for (Real& value : row) value = 0;
    }}
  }}
  void put(int row, int column, Real value) {{ entry_[row][column - row + width] += value; }}
  // False if the matrix is singular or not finite.
  bool factorise() {{
    for (int c = 0; c < n; ++c) {{
      const int last_row = c + width < n ? c + width : n - 1;
      const int last_column = c + 2 * width < n ? c + 2 * width : n - 1;
      int pivot = c;
      for (int r = c + 1; r <= last_row; ++r) {{
        if (magnitude(at(r, c)) > magnitude(at(pivot, c))) pivot = r;
      }}
      if (!(magnitude(at(pivot, c)) > 0)) return false;
      pivot_[c] = pivot;
      if (pivot != c) {{
        for (int j = c; j <= last_column; ++j) {{
          const Real kept = at(c, j);
          at(c, j) = at(pivot, j);
          at(pivot, j) = kept;
        }}
      }}
      const Real reciprocal = 1 / at(c, c);
      for (int r = c + 1; r <= last_row; ++r) {{
        const Real factor = at(r, c) * reciprocal;
        factor_[c][r - c - 1] = factor;
        for (int j = c + 1; j <= last_column; ++j) at(r, j) -= factor * at(c, j);
      }}
    }}
    return true;
  }}
  void solve(Real (&vector)[n]) const {{
    for (int c = 0; c < n; ++c) {{
      const Real kept = vector[c];
      vector[c] = vector[pivot_[c]];
      if (pivot_[c] != c) vector[pivot_[c]] = kept;
      const int last_row = c + width < n ? c + width : n - 1;
      for (int r = c + 1; r <= last_row; ++r) vector[r] -= factor_[c][r - c - 1] * vector[c];
    }}
    for (int r = n - 1; r >= 0; --r) {{
      const int last_column = r + 2 * width < n ? r + 2 * width : n - 1;
      for (int j = r + 1; j <= last_column; ++j) vector[r] -= at(r, j) * vector[j];
      vector[r] /= at(r, r);
    }}
  }}

 private:
  static constexpr int width = {width};
  static constexpr int columns = 3 * width + 1;
  Real& at(int row, int column) {{ return entry_[row][column - row + width]; }}
  const Real& at(int row, int column) const {{ return entry_[row][column - row + width]; }}
  Real entry_[n][columns] = {{}};
  Real factor_[n][width > 0 ? width : 1] = {{}};
  int pivot_[n] = {{}};
)",
                        fmt::arg("width", width)));
  out.indent();
  out.close(";");
  out.line();
}

void write_sparse_matrix(CodeWriter& out) {
  out.lines(
      R"(// A sparse matrix that is filled again and again by the same sequence of entries.  The first
// filling finds the pattern, later ones only add values in place.
class SparseMatrix {
 public:
  explicit SparseMatrix(int size) : matrix_(size, size) {}
  void clear() {
    next_ = 0;
    if (known_) std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), Real(0));
  }
  void put(int row, int column, Real value) {
    if (known_) {
      matrix_.valuePtr()[place_[next_++]] += value;
    } else {
      entries_.emplace_back(row, column, value);
    }
  }
  // False if the matrix is singular or not finite.
  bool factorise() {
    if (!known_) find_pattern();
    solver_.factorize(matrix_);
    return solver_.info() == Eigen::Success;
  }
  void solve(Eigen::Matrix<Real, Eigen::Dynamic, 1>& vector) {
    vector = solver_.solve(vector).eval();
  }

 private:
  void find_pattern() {
    matrix_.setFromTriplets(entries_.begin(), entries_.end());
    matrix_.makeCompressed();
    for (const Eigen::Triplet<Real>& entry : entries_) {
      const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[entry.col()];
      const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[entry.col() + 1];
      const int* found = std::lower_bound(begin, end, entry.row());
      place_.push_back(static_cast<std::size_t>(found - matrix_.innerIndexPtr()));
    }
    solver_.analyzePattern(matrix_);
    entries_.clear();
    known_ = true;
  }
  bool known_ = false;
  std::size_t next_ = 0;
  std::vector<Eigen::Triplet<Real>> entries_;
  std::vector<std::size_t> place_;
  Eigen::SparseMatrix<Real> matrix_;
  Eigen::SparseLU<Eigen::SparseMatrix<Real>> solver_;
};

)");
}

}  // namespace hamgen
