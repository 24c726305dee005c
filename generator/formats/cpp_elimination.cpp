#include "generator/formats/cpp_elimination.hpp"

namespace hamgen {

const char* elimination_text() {
  return R"(// P A = L U by elimination with partial pivoting, for many right sides.
class Elimination {
 public:
  static constexpr int size = stages * dimension;
  Real& at(int row, int column) { return matrix_[row][column]; }
  // False if the matrix is singular or not finite.
  bool factorise() {
    for (int c = 0; c < size; ++c) {
      int pivot = c;
      for (int r = c + 1; r < size; ++r) {
        if (magnitude(matrix_[r][c]) > magnitude(matrix_[pivot][c])) pivot = r;
      }
      if (!(magnitude(matrix_[pivot][c]) > 0)) return false;
      pivot_[c] = pivot;
      for (int j = 0; pivot != c && j < size; ++j) {
        const Real kept = matrix_[c][j];
        matrix_[c][j] = matrix_[pivot][j];
        matrix_[pivot][j] = kept;
      }
      const Real reciprocal = 1 / matrix_[c][c];
      for (int r = c + 1; r < size; ++r) {
        const Real factor = matrix_[r][c] * reciprocal;
        matrix_[r][c] = factor;
        for (int j = c + 1; j < size; ++j) matrix_[r][j] -= factor * matrix_[c][j];
      }
    }
    return true;
  }
  void solve(Real (&vector)[size]) const {
    for (int c = 0; c < size; ++c) {
      const Real kept = vector[c];
      vector[c] = vector[pivot_[c]];
      if (pivot_[c] != c) vector[pivot_[c]] = kept;
    }
    for (int r = 0; r < size; ++r) {
      for (int j = 0; j < r; ++j) vector[r] -= matrix_[r][j] * vector[j];
    }
    for (int r = size - 1; r >= 0; --r) {
      for (int j = r + 1; j < size; ++j) vector[r] -= matrix_[r][j] * vector[j];
      vector[r] /= matrix_[r][r];
    }
  }

 private:
  Real matrix_[size][size] = {};
  int pivot_[size] = {};
};

)";
}

}  // namespace hamgen
