// Linear systems: what is solved to rounding, and what is refused.
#include "tests/numerics_blocks/linear_systems.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

TYPED_TEST_SUITE(Matrices, EveryScalar);

// Backward stable elimination errs by some n^2 units of rounding times the condition, which is
// below 100 in the random ones here: 4000 units is generous, and an elimination without pivoting,
// which meets the zeros of the diagonal, has no bound.
TYPED_TEST(Matrices, ADenseSystemWithAZeroDiagonalIsSolved) {
  using Real = typename TypeParam::Scalar;
  Numbers numbers;
  typename TypeParam::template Dense<6> matrix;
  for (int run = 0; run < 20; ++run) {
    Real entry[6][6];
    this->fill(entry, 6, numbers);
    const double error = this->template error<6>(matrix, entry);
    EXPECT_GE(error, 0);
    EXPECT_LT(error, 4000) << run;
  }
}

// By hand: x = (2, 1) + O(pivot).  Without an exchange of rows 1 - 1/pivot swallows the 1 of row 2.
TYPED_TEST(Matrices, ASmallPivotCostsNoDigits) {
  using Real = typename TypeParam::Scalar;
  const Real pivot = TypeParam::unit * TypeParam::unit;
  typename TypeParam::template Dense<2> dense;
  typename TypeParam::template Band<2, 1> band;
  Real x[2] = {1, 3};
  Real y[2] = {1, 3};
  const Real entry[2][2] = {{pivot, 1}, {1, 1}};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      dense.put(i, j, entry[i][j]);
      band.put(i, j, entry[i][j]);
    }
  }
  ASSERT_TRUE(dense.factorise());
  ASSERT_TRUE(band.factorise());
  dense.solve(x);
  band.solve(y);
  for (const Real* solution : {x, y}) {
    EXPECT_LE(static_cast<double>(TypeParam::absolute(solution[0] - 2) / TypeParam::unit), 4);
    EXPECT_LE(static_cast<double>(TypeParam::absolute(solution[1] - 1) / TypeParam::unit), 4);
  }
}

// Rows that have been exchanged once and again: a cyclic shift.
TYPED_TEST(Matrices, APermutationIsSolvedExactly) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template Dense<5> matrix;
  Real entry[5][5] = {};
  for (int i = 0; i < 5; ++i) entry[i][(i + 2) % 5] = Real(1 + i % 2);
  EXPECT_EQ(this->template error<5>(matrix, entry), 0);
}

TYPED_TEST(Matrices, ABandWithAZeroDiagonalIsSolvedAsAFullMatrixIs) {
  using Real = typename TypeParam::Scalar;
  Numbers numbers;
  typename TypeParam::template Band<8, 1> narrow;
  typename TypeParam::template Band<8, 3> wide;
  for (int run = 0; run < 20; ++run) {
    Real entry[8][8];
    this->fill(entry, 1, numbers);
    EXPECT_GE(this->template error<8>(narrow, entry), 0);
    EXPECT_LT(this->template error<8>(narrow, entry), 200000) << run;
    this->fill(entry, 3, numbers);
    EXPECT_GE(this->template error<8>(wide, entry), 0);
    EXPECT_LT(this->template error<8>(wide, entry), 4000) << run;
  }
}

// Of diagonals beyond 4 and the others below 1/4: the condition is below 3, so that what is
// backward stable errs by some units.  Only the lower half is read.
TYPED_TEST(Matrices, ADefiniteSymmetricSystemIsSolvedFromItsLowerHalf) {
  using Real = typename TypeParam::Scalar;
  Numbers numbers;
  for (int run = 0; run < 20; ++run) {
    typename TypeParam::template Symmetric<6> matrix;
    typename TypeParam::template Dense<6> dense;
    Real solution[6] = {};
    Real expected[6] = {};
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Real entry = i == j ? 5 + Real(numbers.next()) : Real(numbers.next()) / 4;
        matrix.put(i, j, entry);
        dense.put(i, j, entry);
        if (i != j) dense.put(j, i, entry);
      }
      solution[i] = expected[i] = Real(numbers.next());
    }
    ASSERT_TRUE(matrix.factorise());
    ASSERT_TRUE(dense.factorise());
    matrix.solve(solution);
    dense.solve(expected);
    for (int i = 0; i < 6; ++i) {
      EXPECT_LT(
          static_cast<double>(TypeParam::absolute(solution[i] - expected[i]) / TypeParam::unit), 8)
          << run;
    }
  }
}

// Not definite: bit for bit as any other matrix, whose lower half is mirrored.
TYPED_TEST(Matrices, AnIndefiniteSymmetricSystemIsEliminatedWithPivots) {
  using Real = typename TypeParam::Scalar;
  Numbers numbers;
  for (const Real& corner : {Real(0), Real(-1), Real(1)}) {
    typename TypeParam::template Symmetric<5> matrix;
    typename TypeParam::template Dense<5> dense;
    Real solution[5] = {};
    Real expected[5] = {};
    for (int i = 0; i < 5; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Real entry = i + j == 0 ? corner : Real(numbers.next());
        matrix.put(i, j, entry);
        dense.put(i, j, entry);
        if (i != j) dense.put(j, i, entry);
      }
      solution[i] = expected[i] = Real(i - 2);
    }
    ASSERT_TRUE(matrix.factorise());
    ASSERT_TRUE(dense.factorise());
    matrix.solve(solution);
    dense.solve(expected);
    for (int i = 0; i < 5; ++i)
      EXPECT_EQ(static_cast<double>(solution[i] - expected[i]), 0) << static_cast<double>(corner);
  }
}

TYPED_TEST(Matrices, ASingularSymmetricSystemIsRefused) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template Symmetric<4> matrix;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j <= i; ++j) matrix.put(i, j, Real(1));
  }
  EXPECT_FALSE(matrix.factorise());
  matrix.clear();
  for (int i = 0; i < 4; ++i) matrix.put(i, i, Real(2));
  EXPECT_TRUE(matrix.factorise());
}

// A symmetric band as a band and as a symmetric one, with this added to its diagonal.
template <class Bands, class Real, int Width>
struct SymmetricBands {
  typename Bands::template SymmetricBand<7, Width> symmetric;
  typename Bands::template Band<7, Width> plain;
  void fill(Numbers& numbers, const Real& diagonal) {
    symmetric.clear();
    plain.clear();
    for (int i = 0; i < 7; ++i) {
      for (int j = i; j <= i + Width && j < 7; ++j) {
        const Real entry = i == j ? diagonal + Real(numbers.next()) : Real(numbers.next()) / 4;
        put(i, j, entry);
        if (i != j) put(j, i, entry);
      }
    }
  }

 private:
  void put(int row, int column, const Real& entry) {
    symmetric.put(row, column, entry);
    plain.put(row, column, entry);
  }
};
// The largest difference of both solutions in units; less than 0 if one of them is refused.
template <class Bands, class Real, int Width>
double difference(SymmetricBands<Bands, Real, Width>& matrix, Numbers& numbers) {
  Real solution[7];
  Real expected[7];
  for (int i = 0; i < 7; ++i) solution[i] = expected[i] = Real(numbers.next());
  if (!matrix.symmetric.factorise() || !matrix.plain.factorise()) return -1;
  matrix.symmetric.solve(solution);
  matrix.plain.solve(expected);
  double most = 0;
  for (int i = 0; i < 7; ++i) {
    const Real gap = Bands::absolute(solution[i] - expected[i]) / Bands::unit;
    most = std::max(most, static_cast<double>(gap));
  }
  return most;
}

// Diagonals beyond 4 and others below 1/4, at most three beside them: the condition is below 3.
// The object has been filled with an indefinite matrix before.
TYPED_TEST(Matrices, ADefiniteSymmetricBandIsSolvedAsABandIs) {
  using Real = typename TypeParam::Scalar;
  Numbers numbers;
  SymmetricBands<TypeParam, Real, 1> narrow;
  SymmetricBands<TypeParam, Real, 3> wide;
  for (int run = 0; run < 20; ++run) {
    for (const Real& diagonal : {Real(0), Real(5)}) {
      narrow.fill(numbers, diagonal);
      wide.fill(numbers, diagonal);
      const double of_narrow = difference(narrow, numbers);
      const double of_wide = difference(wide, numbers);
      EXPECT_GE(of_narrow, 0) << run;
      EXPECT_GE(of_wide, 0) << run;
      if (diagonal == 0) continue;
      EXPECT_LT(of_narrow, 8) << run;
      EXPECT_LT(of_wide, 8) << run;
    }
  }
}

// Not definite: bit for bit as any other band, also where the last row alone is not.
TYPED_TEST(Matrices, AnIndefiniteSymmetricBandIsEliminatedWithPivots) {
  using Real = typename TypeParam::Scalar;
  Numbers numbers;
  SymmetricBands<TypeParam, Real, 2> matrix;
  for (int run = 0; run < 20; ++run) {
    matrix.fill(numbers, Real(5));
    matrix.symmetric.put(6, 6, Real(-11));
    matrix.plain.put(6, 6, Real(-11));
    EXPECT_EQ(difference(matrix, numbers), 0) << run;
    matrix.fill(numbers, Real(-5));
    EXPECT_EQ(difference(matrix, numbers), 0) << run;
  }
}

TYPED_TEST(Matrices, ASingularSymmetricBandIsRefused) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template SymmetricBand<4, 1> matrix;
  for (int i = 0; i < 4; ++i) matrix.put(i, i, Real(i < 3 ? 1 : 0));
  EXPECT_FALSE(matrix.factorise());
  matrix.put(3, 3, Real(2));
  matrix.clear();
  for (int i = 0; i < 4; ++i) matrix.put(i, i, Real(2));
  EXPECT_TRUE(matrix.factorise());
}

TYPED_TEST(Matrices, OneFactorisationServesManyRightSides) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template Dense<3> matrix;
  const Real entry[3][3] = {{0, 2, 1}, {4, 0, -1}, {1, 1, 8}};
  ASSERT_GE(this->template error<3>(matrix, entry), 0);
  Real inverse[3][3];
  matrix.clear();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix.put(i, j, entry[i][j]);
  }
  ASSERT_TRUE(TypeParam::inverse(matrix, inverse));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Real sum = i == j ? -1 : 0;
      for (int k = 0; k < 3; ++k) sum += entry[i][k] * inverse[k][j];
      EXPECT_LE(static_cast<double>(TypeParam::absolute(sum) / TypeParam::unit), 16);
    }
  }
}

TYPED_TEST(Matrices, ASingularOneIsRefused) {
  using Real = typename TypeParam::Scalar;
  const Real entry[3][3] = {{1, 2, 0}, {2, 4, 0}, {0, 0, 1}};
  typename TypeParam::template Dense<3> dense;
  typename TypeParam::template Band<3, 1> band;
  typename TypeParam::template Diagonal<3> diagonal;
  EXPECT_EQ(this->template error<3>(dense, entry), -1);
  EXPECT_EQ(this->template error<3>(band, entry), -1);
  const Real hole[3][3] = {{1, 0, 0}, {0, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(this->template error<3>(diagonal, hole), -1);
  // So is the last row alone, where nothing is left to exchange with.
  const Real last[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(this->template error<3>(dense, last), -1);
  EXPECT_EQ(this->template error<3>(band, last), -1);
  EXPECT_EQ(this->template error<3>(diagonal, last), -1);
  Real inverse[3][3];
  dense.clear();
  EXPECT_FALSE(TypeParam::inverse(dense, inverse));
}

TYPED_TEST(Matrices, OneThatIsNotANumberIsRefused) {
  using Real = typename TypeParam::Scalar;
  const Real infinite = Real(__builtin_inf());
  typename TypeParam::template Dense<2> dense;
  typename TypeParam::template Band<2, 1> band;
  typename TypeParam::template Diagonal<2> diagonal;
  const Real entry[2][2] = {{infinite - infinite, 0}, {0, 1}};
  EXPECT_EQ(this->template error<2>(dense, entry), -1);
  EXPECT_EQ(this->template error<2>(band, entry), -1);
  EXPECT_EQ(this->template error<2>(diagonal, entry), -1);
}

TYPED_TEST(Matrices, ADiagonalIsDividedBy) {
  using Real = typename TypeParam::Scalar;
  const Real entry[4][4] = {{2, 0, 0, 0}, {0, -4, 0, 0}, {0, 0, 8, 0}, {0, 0, 0, 1}};
  typename TypeParam::template Diagonal<4> matrix;
  EXPECT_EQ(this->template error<4>(matrix, entry), 0);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
