// How the matrix of a system in loops is stored.
#include <fmt/format.h>

#include "generator/formats/cpp_pieces.hpp"

namespace hamgen {

namespace {

// The body of Order::row(i).
std::string row_of(const ArrayMatrix& matrix) {
  const int length = matrix.size / matrix.arrays;
  std::string text = matrix.arrays == 1 ? "" : fmt::format("    const int k = i % {};\n", length);
  const char* k = matrix.arrays == 1 ? "i" : "k";
  const std::string row =
      matrix.folded ? fmt::format("2 * {0} < {1} ? 2 * {0} : 2 * ({1} - 1 - {0}) + 1", k, length)
                    : std::string(k);
  if (matrix.arrays == 1) return fmt::format("    return {};\n", row);
  if (!matrix.folded)
    return text + fmt::format("    return {} * k + i / {};\n", matrix.arrays, length);
  return text + fmt::format("    const int row = {};\n    return {} * row + i / {};\n", row,
                            matrix.arrays, length);
}

std::string order_text(const ArrayMatrix& matrix) {
  std::string text;
  if (matrix.arrays > 1) {
    text = fmt::format("The {} arrays element by element", matrix.arrays);
  }
  if (matrix.folded) {
    text += text.empty() ? "The " : ", the ";
    text += "ring folded flat: first, last, second, last but one, ...";
  } else {
    text += ".";
  }
  return text;
}

void write_band(CodeWriter& out, const ArrayMatrix& matrix) {
  const std::string band = fmt::format("BandMatrix<{}, {}>", matrix.size, matrix.bandwidth);
  if (matrix.in_natural_order()) {
    out.line(fmt::format("using Matrix = {};", band));
    return;
  }
  out.comment("// ", order_text(matrix));
  out.lines("struct Order {\n  static int row(int i) {\n" + row_of(matrix) + "  }\n};\n\n");
  out.line(fmt::format("using Matrix = ReorderedMatrix<{}, Order>;", band));
}

// The matrices that need no more than their size.
void write_plain(CodeWriter& out, const char* name, int size) {
  out.line(fmt::format("using Matrix = {}<{}>;", name, size));
}

}  // namespace

void write_matrix(CodeWriter& out, const ArrayMatrix& matrix) {
  switch (matrix.kind) {
    case MatrixKind::band:
      if (matrix.bandwidth > 0) {
        write_band(out, matrix);
      } else {  // a band of no width
        write_plain(out, "DiagonalMatrix", matrix.size);
      }
      break;
    case MatrixKind::dense:
      write_plain(out, "DenseMatrix", matrix.size);
      break;
    case MatrixKind::eigen_dense:
      write_plain(out, "EigenDenseMatrix", matrix.size);
      break;
    case MatrixKind::eigen_sparse:
      write_plain(out, "EigenSparseMatrix", matrix.size);
      break;
  }
  out.line();
}

}  // namespace hamgen
