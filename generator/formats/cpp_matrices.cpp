// The matrices of large systems: one class Matrix with clear, put, factorise and solve.
#include <fmt/format.h>

#include "generator/formats/cpp_arrays.hpp"

namespace hamgen {

namespace {

constexpr const char* kBand =
    R"(  void clear() {{
    for (auto& row : entry_) {{
      for (Real& value : row) value = 0;
    }}
  }}
  void put(int row, int column, Real value) {{ at({row}, {column}) += value; }}
  // False if the matrix is singular or not finite.
  bool factorise() {{
    for (int c = 0; c < size; ++c) {{
      const int last_row = c + width < size ? c + width : size - 1;
      const int last_column = c + 2 * width < size ? c + 2 * width : size - 1;
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
  void solve(Real (&{argument})[size]) const {{
{reorder}    for (int c = 0; c < size; ++c) {{
      const Real kept = x[c];
      x[c] = x[pivot_[c]];
      if (pivot_[c] != c) x[pivot_[c]] = kept;
      const int last_row = c + width < size ? c + width : size - 1;
      for (int r = c + 1; r <= last_row; ++r) x[r] -= factor_[c][r - c - 1] * x[c];
    }}
    for (int r = size - 1; r >= 0; --r) {{
      const int last_column = r + 2 * width < size ? r + 2 * width : size - 1;
      for (int j = r + 1; j <= last_column; ++j) x[r] -= at(r, j) * x[j];
      x[r] /= at(r, r);
    }}
{restore}  }}

 private:
  static constexpr int width = {width};
  static constexpr int columns = 3 * width + 1;
  Real& at(int row, int column) {{ return entry_[row][column - row + width]; }}
  const Real& at(int row, int column) const {{ return entry_[row][column - row + width]; }}
{members}  Real entry_[size][columns] = {{}};
  Real factor_[size][width] = {{}};
  int pivot_[size] = {{}};
)";

// Where unknown i stands, for the constructor of the class.
std::string ordering(const ArrayMatrix& matrix) {
  const int length = matrix.size / matrix.arrays;
  const std::string element = matrix.arrays == 1 ? "i" : fmt::format("i % {}", length);
  std::string text = "  Matrix() {\n    for (int i = 0; i < size; ++i) {\n";
  std::string row = element;
  if (matrix.folded) {
    if (matrix.arrays > 1) text += fmt::format("      const int k = {};\n", element);
    const char* k = matrix.arrays > 1 ? "k" : "i";
    row = fmt::format("2 * {0} < {1} ? 2 * {0} : 2 * ({1} - 1 - {0}) + 1", k, length);
  }
  if (matrix.arrays == 1) {
    text += fmt::format("      place_[i] = {};\n", row);
  } else {
    text += fmt::format("      const int row = {};\n", row);
    text += fmt::format("      place_[i] = {} * row + i / {};\n", matrix.arrays, length);
  }
  return text + "    }\n  }\n";
}

std::string order_text(const ArrayMatrix& matrix) {
  std::string text;
  if (matrix.arrays > 1) {
    text = fmt::format("the {} arrays element by element", matrix.arrays);
  }
  if (matrix.folded) {
    text += text.empty() ? "" : ", ";
    text += "the ring folded flat: first, last, second, last but one, ...";
  }
  return text;
}

void write_band(CodeWriter& out, const ArrayMatrix& matrix) {
  const bool natural = matrix.in_natural_order();
  std::string order = natural ? "" : ", with the unknowns in this order: " + order_text(matrix);
  out.comment("// ", fmt::format("A matrix whose entries lie within {} of the diagonal{}. "
                                 "Elimination with partial pivoting fills as many diagonals again "
                                 "above it. Row i holds columns i - width on.",
                                 matrix.bandwidth, order));
  out.line("class Matrix {");
  out.lines(fmt::format(" public:\n  static constexpr int size = {};\n", matrix.size));
  if (!natural) out.lines(ordering(matrix));
  out.lines(fmt::format(
      fmt::runtime(kBand), fmt::arg("width", matrix.bandwidth),
      fmt::arg("row", natural ? "row" : "place_[row]"),
      fmt::arg("column", natural ? "column" : "place_[column]"),
      fmt::arg("argument", natural ? "x" : "vector"),
      fmt::arg("reorder", natural
                              ? ""
                              : "    Real x[size];\n"
                                "    for (int i = 0; i < size; ++i) x[place_[i]] = vector[i];\n"),
      fmt::arg("restore", natural ? ""
                                  : "    for (int i = 0; i < size; ++i) vector[i] = "
                                    "x[place_[i]];\n"),
      fmt::arg("members", natural ? "" : "  int place_[size] = {};  // the row of unknown i\n")));
  out.lines("};\n\n");
}

// A band of no width.
constexpr const char* kDiagonal = R"(// A diagonal matrix.
class Matrix {{
 public:
  static constexpr int size = {size};
  void clear() {{
    for (Real& value : entry_) value = 0;
  }}
  void put(int row, int, Real value) {{ entry_[row] += value; }}
  // False if the matrix is singular or not finite.
  bool factorise() const {{
    for (const Real value : entry_) {{
      if (!(magnitude(value) > 0)) return false;
    }}
    return true;
  }}
  void solve(Real (&vector)[size]) const {{
    for (int i = 0; i < size; ++i) vector[i] /= entry_[i];
  }}

 private:
  Real entry_[size] = {{}};
}};

)";

constexpr const char* kDense =
    R"(// A full matrix: P A = L U by elimination with partial pivoting.
class Matrix {{
 public:
  static constexpr int size = {size};
  void clear() {{
    for (auto& row : entry_) {{
      for (Real& value : row) value = 0;
    }}
  }}
  void put(int row, int column, Real value) {{ entry_[row][column] += value; }}
  // False if the matrix is singular or not finite.
  bool factorise() {{
    for (int c = 0; c < size; ++c) {{
      int pivot = c;
      for (int r = c + 1; r < size; ++r) {{
        if (magnitude(entry_[r][c]) > magnitude(entry_[pivot][c])) pivot = r;
      }}
      if (!(magnitude(entry_[pivot][c]) > 0)) return false;
      pivot_[c] = pivot;
      for (int j = 0; pivot != c && j < size; ++j) {{
        const Real kept = entry_[c][j];
        entry_[c][j] = entry_[pivot][j];
        entry_[pivot][j] = kept;
      }}
      const Real reciprocal = 1 / entry_[c][c];
      for (int r = c + 1; r < size; ++r) {{
        const Real factor = entry_[r][c] * reciprocal;
        entry_[r][c] = factor;
        for (int j = c + 1; j < size; ++j) entry_[r][j] -= factor * entry_[c][j];
      }}
    }}
    return true;
  }}
  void solve(Real (&vector)[size]) const {{
    for (int c = 0; c < size; ++c) {{
      const Real kept = vector[c];
      vector[c] = vector[pivot_[c]];
      if (pivot_[c] != c) vector[pivot_[c]] = kept;
    }}
    for (int r = 0; r < size; ++r) {{
      for (int j = 0; j < r; ++j) vector[r] -= entry_[r][j] * vector[j];
    }}
    for (int r = size - 1; r >= 0; --r) {{
      for (int j = r + 1; j < size; ++j) vector[r] -= entry_[r][j] * vector[j];
      vector[r] /= entry_[r][r];
    }}
  }}

 private:
  Real entry_[size][size] = {{}};
  int pivot_[size] = {{}};
}};

)";

constexpr const char* kEigenDense = R"(// A full matrix.
class Matrix {{
 public:
  static constexpr int size = {size};
  void clear() {{ matrix_.setZero(); }}
  void put(int row, int column, Real value) {{ matrix_(row, column) += value; }}
  // False if the matrix is singular or not finite.
  bool factorise() {{
    solver_.compute(matrix_);
    const auto pivots = solver_.matrixLU().diagonal().cwiseAbs();
    return pivots.minCoeff() > 0;
  }}
  void solve(Real (&vector)[size]) {{
    Eigen::Map<Eigen::Matrix<Real, size, 1>> x(&vector[0]);
    x = solver_.solve(x).eval();
  }}

 private:
  using Full = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  Full matrix_ = Full::Zero(size, size);
  Eigen::PartialPivLU<Full> solver_{{size}};
}};

)";

constexpr const char* kSparse =
    R"(// A sparse matrix that is filled again and again by the same sequence of entries.  The first
// filling finds the pattern, later ones only add values in place.
class Matrix {{
 public:
  static constexpr int size = {size};
  void clear() {{
    next_ = 0;
    if (known_) std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), Real(0));
  }}
  void put(int row, int column, Real value) {{
    if (known_) {{
      matrix_.valuePtr()[place_[next_++]] += value;
    }} else {{
      entries_.emplace_back(row, column, value);
    }}
  }}
  // False if the matrix is singular or not finite.
  bool factorise() {{
    if (!known_) find_pattern();
    solver_.factorize(matrix_);
    return solver_.info() == Eigen::Success;
  }}
  void solve(Real (&vector)[size]) {{
    Eigen::Map<Eigen::Matrix<Real, Eigen::Dynamic, 1>> x(&vector[0], size);
    x = solver_.solve(x).eval();
  }}

 private:
  void find_pattern() {{
    matrix_.setFromTriplets(entries_.begin(), entries_.end());
    matrix_.makeCompressed();
    for (const Eigen::Triplet<Real>& entry : entries_) {{
      const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[entry.col()];
      const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[entry.col() + 1];
      const int* found = std::lower_bound(begin, end, entry.row());
      place_.push_back(static_cast<std::size_t>(found - matrix_.innerIndexPtr()));
    }}
    solver_.analyzePattern(matrix_);
    entries_.clear();
    known_ = true;
  }}
  bool known_ = false;
  std::size_t next_ = 0;
  std::vector<Eigen::Triplet<Real>> entries_;
  std::vector<std::size_t> place_;
  Eigen::SparseMatrix<Real> matrix_{{size, size}};
  Eigen::SparseLU<Eigen::SparseMatrix<Real>> solver_;
}};

)";

}  // namespace

void write_array_matrix(CodeWriter& out, const ArrayMatrix& matrix) {
  const auto write = [&](const char* text) {
    out.lines(fmt::format(fmt::runtime(text), fmt::arg("size", matrix.size)));
  };
  switch (matrix.kind) {
    case MatrixKind::band:
      if (matrix.bandwidth > 0) return write_band(out, matrix);
      return write(kDiagonal);
    case MatrixKind::dense:
      return write(kDense);
    case MatrixKind::eigen_dense:
      return write(kEigenDense);
    case MatrixKind::eigen_sparse:
      return write(kSparse);
  }
}

}  // namespace hamgen
