// Linear systems with known solutions, for every scalar.
#pragma once

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {

template <class Blocks>
class Matrices : public ::testing::Test {
 protected:
  using Number = typename Blocks::Scalar;

  // Fills the matrix with the entries and solves for a known solution x_i = i - 2, from its image,
  // which is exact.  Returns the largest error in units of rounding, -1 if it was refused.
  template <int Size, class Matrix>
  static double error(Matrix& matrix, const Number (&entry)[Size][Size]) {
    Number vector[Size] = {};
    matrix.clear();
    for (int i = 0; i < Size; ++i) {
      for (int j = 0; j < Size; ++j) {
        if (entry[i][j] != 0) matrix.put(i, j, entry[i][j]);
        vector[i] += entry[i][j] * Number(j - 2);
      }
    }
    if (!matrix.factorise()) return -1;
    matrix.solve(vector);
    Number worst = 0;
    for (int i = 0; i < Size; ++i) {
      const Number off = Blocks::absolute(vector[i] - Number(i - 2));
      if (!(off <= worst)) worst = off;
    }
    return static_cast<double>(worst / Blocks::unit);
  }

  // Random, nothing below the `width`-th diagonal or above it, and zeros on the diagonal.
  template <int Size>
  static void fill(Number (&entry)[Size][Size], int width, Numbers& numbers) {
    for (int i = 0; i < Size; ++i) {
      for (int j = 0; j < Size; ++j) {
        const bool inside = i - j <= width && j - i <= width && i != j;
        entry[i][j] = inside ? Number(numbers.next()) : Number(0);
      }
    }
  }
};

}  // namespace hamgen::numerics_blocks_test
