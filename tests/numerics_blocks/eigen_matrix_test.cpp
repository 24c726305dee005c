// The matrices that Eigen eliminates, in double: the same interface, the same answers, the same
// refusals.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hamgen::numerics_blocks_test {
namespace {

using Real = double;
#include "generator/numerics/eigen_dense_matrix.hpp"
#include "generator/numerics/eigen_sparse_matrix.hpp"

// A ring of `size` with a zero on the diagonal at every third place, for x_i = i: entries and
// solution are integers, and 1e-12 is some thousand roundings of the largest.
template <class Matrix>
void solve_a_ring(Matrix& matrix) {
  constexpr int size = Matrix::size;
  double vector[size] = {};
  matrix.clear();
  for (int i = 0; i < size; ++i) {
    const auto put = [&](int column, double value) {
      matrix.put(i, column, value);
      vector[i] += value * column;
    };
    put(i, i % 3 == 0 ? 0 : 5);
    put((i + 1) % size, 2);
    put((i + size - 1) % size, -1);
  }
  ASSERT_TRUE(matrix.factorise());
  matrix.solve(vector);
  for (int i = 0; i < size; ++i) EXPECT_NEAR(vector[i], i, 1e-12 * size) << i;
}

TEST(EigenMatrices, AreSolvedAgainAndAgain) {
  EigenDenseMatrix<30> small;
  EigenDenseMatrix<100> large;
  EigenSparseMatrix<30> sparse;
  for (int run = 0; run < 3; ++run) {
    solve_a_ring(small);
    solve_a_ring(large);
    solve_a_ring(sparse);
  }
}

TEST(EigenMatrices, ASingularOneIsRefused) {
  EigenDenseMatrix<3> dense;
  EigenSparseMatrix<3> sparse;
  dense.clear();
  sparse.clear();
  for (int i = 0; i < 3; ++i) {
    dense.put(i, 0, 1 + i);
    sparse.put(i, 0, 1 + i);
    sparse.put(i, i, 0);
  }
  EXPECT_FALSE(dense.factorise());
  EXPECT_FALSE(sparse.factorise());
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
