// How the matrix of a system in loops is stored.
#include <fmt/format.h>

#include "generator/formats/cpp_pieces.hpp"

namespace hamgen {

namespace {

std::string band_type(const ArrayMatrix& matrix) {
  if (matrix.bandwidth == 0) return fmt::format("DiagonalMatrix<{}>", matrix.size);
  const std::string band = fmt::format("BandMatrix<{}, {}>", matrix.size, matrix.bandwidth);
  if (matrix.in_natural_order()) return band;
  return fmt::format("ReorderedMatrix<{}, ElementOrder<{}, {}, {}>>", band, matrix.arrays,
                     matrix.size / matrix.arrays, matrix.folded);
}

std::string type_of(const ArrayMatrix& matrix) {
  switch (matrix.kind) {
    case MatrixKind::band:
      return band_type(matrix);
    case MatrixKind::dense:
      return fmt::format("DenseMatrix<{}>", matrix.size);
    case MatrixKind::eigen_dense:
      return fmt::format("EigenDenseMatrix<{}>", matrix.size);
    case MatrixKind::eigen_sparse:
      return fmt::format("EigenSparseMatrix<{}>", matrix.size);
  }
  internal_error("unknown matrix");
}

}  // namespace

void write_matrix(CodeWriter& out, const ArrayMatrix& matrix) {
  out.line(fmt::format("using Matrix = {};", type_of(matrix)));
  out.line();
}

}  // namespace hamgen
