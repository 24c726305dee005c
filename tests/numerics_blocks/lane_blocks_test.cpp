// The blocks of a batch: what is decided in a lane is decided as for one trajectory alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {

namespace packs {
#include "tests/numerics_blocks/packs.inc"
}  // namespace packs

namespace {

constexpr int kLanes = 8;
constexpr int kRows = 5;

// Numbers in all places of a matrix, or in those of a band.
template <class Together, class Alone>
void fill(Together& together, Alone (&alone)[kLanes], Numbers& numbers, int width,
          int /*filling*/ = 0) {
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kRows; ++c) {
      if (r - c > width || c - r > width) continue;
      packs::Real entry = 0;
      for (int lane = 0; lane < kLanes; ++lane) {
        double value = numbers.next() / 3;
        if (lane == 3 && r == 2) value = 0;
        if (lane == 5 && r == 1 && c == 2) value = std::numeric_limits<double>::quiet_NaN();
        entry.set(lane, value);
        alone[lane].put(r, c, value);
      }
      together.put(r, c, entry);
    }
  }
}
// The same of a symmetric one, definite in lanes 0 and 7, first in lane 6 and then in lane 1.
template <class Together, int Width>
void fill(Together& together, of_double::SymmetricBandMatrix<kRows, Width> (&alone)[kLanes],
          Numbers& numbers, int width, int filling = 0) {
  const auto is_definite = [filling](int lane) {
    return lane == 0 || lane == 7 || lane == (filling == 0 ? 6 : 1);
  };
  for (int r = 0; r < kRows; ++r) {
    for (int c = r; c < kRows && c <= r + width; ++c) {
      packs::Real entry = 0;
      for (int lane = 0; lane < kLanes; ++lane) {
        double value = numbers.next() / 3;
        if (r == c && is_definite(lane)) value += 2;
        if (lane == 3 && (r == 2 || c == 2)) value = 0;
        if (lane == 5 && r == 1 && c == 2) value = std::numeric_limits<double>::quiet_NaN();
        entry.set(lane, value);
        alone[lane].put(r, c, value);
        if (c > r) alone[lane].put(c, r, value);
      }
      together.put(r, c, entry);
      if (c > r) together.put(c, r, entry);
    }
  }
}
// The right side and the solution in each lane.
struct Sides {
  packs::Real together[kRows] = {};
  double alone[kLanes][kRows] = {};
  explicit Sides(Numbers& numbers) {
    for (int lane = 0; lane < kLanes; ++lane) {
      for (int r = 0; r < kRows; ++r) {
        alone[lane][r] = numbers.next();
        together[r].set(lane, alone[lane][r]);
      }
    }
  }
  void expect_equal(int lane) const {
    for (int r = 0; r < kRows; ++r) EXPECT_EQ(together[r][lane], alone[lane][r]) << lane;
  }
};

// Every lane has pivots of its own; that of lane 3 is singular, which a border may not show, and
// lane 5 has a NaN.
template <class Together, class Alone>
void expect_solved_as_alone(int width, bool shows = true) {
  Numbers numbers;
  Together together;
  Alone alone[kLanes];
  fill(together, alone, numbers, width);
  Sides sides(numbers);
  const packs::Mask regular = together.factorise();
  together.solve(sides.together);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(regular[lane], (lane != 3 || !shows) && lane != 5) << lane;
    ASSERT_EQ(alone[lane].factorise(), regular[lane]) << lane;
    if (!regular[lane]) continue;
    alone[lane].solve(sides.alone[lane]);
    sides.expect_equal(lane);
  }
}

TEST(LaneBlocks, AMatrixIsSolvedInEachLaneBitForBitAsAlone) {
  expect_solved_as_alone<packs::DenseMatrix<kRows>, of_double::DenseMatrix<kRows>>(kRows);
}

TEST(LaneBlocks, ABandIsSolvedInEachLaneBitForBitAsAlone) {
  expect_solved_as_alone<packs::BandMatrix<kRows, 1>, of_double::BandMatrix<kRows, 1>>(1);
  expect_solved_as_alone<packs::BandMatrix<kRows, 2>, of_double::BandMatrix<kRows, 2>>(2);
  using Order = of_double::ElementOrder<1, kRows, true>;
  expect_solved_as_alone<packs::ReorderedMatrix<packs::BandMatrix<kRows, 4>, Order>,
                         of_double::ReorderedMatrix<of_double::BandMatrix<kRows, 4>, Order>>(kRows);
}

TEST(LaneBlocks, ABorderIsSolvedInEachLaneBitForBitAsAlone) {
  expect_solved_as_alone<packs::BorderedMatrix<packs::DenseMatrix<kRows - 2>, 2>,
                         of_double::BorderedMatrix<of_double::DenseMatrix<kRows - 2>, 2>>(kRows,
                                                                                          false);
}

TEST(LaneBlocks, ASymmetricBandIsSolvedInEachLaneBitForBitAsAlone) {
  expect_solved_as_alone<packs::SymmetricBandMatrix<kRows, 1>,
                         of_double::SymmetricBandMatrix<kRows, 1>>(1);
  expect_solved_as_alone<packs::SymmetricBandMatrix<kRows, 3>,
                         of_double::SymmetricBandMatrix<kRows, 3>>(3);
}

// Of a matrix that serves some lanes have factors of the second filling, the others of the first.
template <class Together, class Alone>
void expect_kept_as_alone(int width) {
  Numbers numbers;
  packs::KeptMatrix<Together> together;
  Alone alone[2][kLanes];
  for (int filling = 0; filling < 2; ++filling) {
    together.clear();
    fill(together, alone[filling], numbers, width, filling);
    packs::Real lanes = filling == 0 ? 1 : 0;
    for (const int lane : {1, 3, 6}) lanes.set(lane, 1);
    const packs::Mask regular = together.factorise(lanes > 0);
    EXPECT_FALSE(regular[3]);
    EXPECT_EQ(regular[5], filling == 1);
  }
  Sides sides(numbers);
  packs::Real asked = 1;
  asked.set(7, 0);
  together.solve(asked > 0, sides.together);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (lane == 3 || lane == 5) continue;
    Alone& last = alone[lane == 1 || lane == 6 ? 1 : 0][lane];
    ASSERT_TRUE(last.factorise());
    if (lane != 7) last.solve(sides.alone[lane]);
    sides.expect_equal(lane);
  }
}

TEST(LaneBlocks, FactorsServeEachLaneUntilItWantsOthers) {
  expect_kept_as_alone<packs::DenseMatrix<kRows>, of_double::DenseMatrix<kRows>>(kRows);
  expect_kept_as_alone<packs::BorderedMatrix<packs::DenseMatrix<kRows - 3>, 3>,
                       of_double::BorderedMatrix<of_double::DenseMatrix<kRows - 3>, 3>>(kRows);
  expect_kept_as_alone<packs::BandMatrix<kRows, 2>, of_double::BandMatrix<kRows, 2>>(2);
  expect_kept_as_alone<packs::SymmetricBandMatrix<kRows, 2>,
                       of_double::SymmetricBandMatrix<kRows, 2>>(2);
}

// A torus of 3 rows: its order is found, and what the other lanes have changes no bit.
TEST(LaneBlocks, ASparseMatrixIsSolvedInEachLaneAsAlone) {
  constexpr int size = 15;
  const auto value = [](int lane, int i, int k) {
    return i == k ? (lane == 2 ? 0 : 0.1 * lane - 0.3) : std::sin(1.0 + lane + i + 3 * k);
  };
  const auto fill_torus = [&](auto& matrix, const auto& entry) {
    matrix.clear();
    for (int i = 0; i < size; ++i) {
      for (const int way : {0, 1, 3, size - 1, size - 3})
        matrix.put(i, (i + way) % size, entry(i, (i + way) % size));
    }
  };
  packs::KeptMatrix<packs::SparseMatrix<size>> mixed;
  packs::Real sides[size] = {};
  for (int i = 0; i < size; ++i) sides[i] = 1 + i;
  for (int filling = 0; filling < 2; ++filling) {
    fill_torus(mixed, [&](int i, int k) {
      packs::Real entry = 0;
      for (int lane = 0; lane < kLanes; ++lane) entry.set(lane, value(lane, i, k));
      return entry;
    });
    ASSERT_TRUE(all(mixed.factorise(true)));
  }
  mixed.solve(true, sides);
  for (int lane = 0; lane < kLanes; ++lane) {
    packs::SparseMatrix<size> equal;
    fill_torus(equal, [&](int i, int k) { return packs::Real(value(lane, i, k)); });
    of_double::DenseMatrix<size> dense;
    fill_torus(dense, [&](int i, int k) { return value(lane, i, k); });
    packs::Real alone[size] = {};
    double expected[size] = {};
    for (int i = 0; i < size; ++i) alone[i] = expected[i] = 1 + i;
    ASSERT_TRUE(all(equal.factorise()) && dense.factorise());
    equal.solve(alone);
    dense.solve(expected);
    for (int i = 0; i < size; ++i) {
      EXPECT_EQ(sides[i][lane], alone[i][0]) << lane;
      EXPECT_NEAR(sides[i][lane], expected[i], 1e-10 * (1 + std::fabs(expected[i]))) << lane;
    }
  }
  packs::SparseMatrix<size> singular;
  fill_torus(singular, [&](int i, int k) { return packs::Real(i == 4 ? 0 : value(1, i, k)); });
  EXPECT_FALSE(any(singular.factorise()));
}

TEST(LaneBlocks, ASymmetricMatrixIsItsLowerHalfMirrored) {
  Numbers numbers;
  packs::SymmetricMatrix<kRows> half;
  packs::DenseMatrix<kRows> whole;
  packs::Real solution[kRows] = {};
  packs::Real expected[kRows] = {};
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j <= i; ++j) {
      packs::Real entry = 0;
      for (int lane = 0; lane < kLanes; ++lane) entry.set(lane, numbers.next());
      half.put(i, j, entry);
      whole.put(i, j, entry);
      if (i != j) whole.put(j, i, entry);
    }
    solution[i] = expected[i] = packs::Real(i + 1);
  }
  ASSERT_TRUE(all(half.factorise()) && all(whole.factorise()));
  half.solve(solution);
  whole.solve(expected);
  for (int i = 0; i < kRows; ++i) {
    for (int lane = 0; lane < kLanes; ++lane) EXPECT_EQ(solution[i][lane], expected[i][lane]);
  }
}

TEST(LaneBlocks, AnInverseIsThatOfEachLane) {
  Numbers numbers;
  packs::DenseMatrix<kRows> together;
  of_double::DenseMatrix<kRows> alone[kLanes];
  fill(together, alone, numbers, kRows);
  packs::Real inverse[kRows][kRows] = {};
  const packs::Mask regular = packs::invert(together, inverse);
  for (int lane = 0; lane < kLanes; ++lane) {
    double other[kRows][kRows] = {};
    ASSERT_EQ(of_double::invert(alone[lane], other), regular[lane]) << lane;
    if (!regular[lane]) continue;
    EXPECT_EQ(inverse[1][2][lane], other[1][2]) << lane;
  }
}

// Cubics are met as soon as four points are known, whatever polynomial or noise is beside them.
TEST(LaneBlocks, PolynomialsArePredictedInTheirLanes) {
  packs::History<1> history;
  Numbers numbers;
  packs::Real predicted[1] = {};
  for (int step = 0; step < 60; ++step) {
    packs::Real point = 0;
    const double x = step;
    for (int lane = 0; lane < kLanes; ++lane) {
      point.set(lane, lane % 2 == 0 ? lane + x - x * x * x / 64 : numbers.next());
    }
    if (step >= 8) {
      for (int lane = 0; lane < kLanes; lane += 2) {
        EXPECT_EQ(predicted[0][lane], point[lane]) << lane << " " << step;
      }
    }
    history.record({point});
    history.extrapolate(predicted);
  }
  EXPECT_GE(history.best[0], 3);
  EXPECT_LE(history.best[1], 4);
  forget(history);
  EXPECT_EQ(history.known, 0);
}

// Whatever degrees the others need.
TEST(LaneBlocks, APredictionDoesNotDependOnTheOtherLanes) {
  packs::History<2> mixed;
  packs::History<2> equal;
  Numbers numbers;
  for (int step = 0; step < 200; ++step) {
    packs::Real point = 0;
    const double x = 0.1 * step;
    for (int lane = 0; lane < kLanes; ++lane) {
      const double smooth = std::sin(x * (lane + 1));
      point.set(lane, lane % 2 == 0 ? smooth : numbers.next());
    }
    const packs::Real same = point[0];
    mixed.record({point, -point});
    equal.record({same, -same});
    packs::Real predicted[2] = {};
    packs::Real alone[2] = {};
    mixed.extrapolate(predicted);
    equal.extrapolate(alone);
    EXPECT_EQ(predicted[0][0], alone[0][0]) << step;
    EXPECT_EQ(predicted[1][0], alone[1][0]) << step;
    if (step > 20) {
      EXPECT_GT(mixed.highest, mixed.best[1]) << step;
    }
  }
}

// k^4 has the first difference 4 k^3 - ... and the fourth 24.
TEST(LaneBlocks, ErrorsAreDifferences) {
  packs::History<2> history;
  const auto power = [](int k) { return double(k) * k * k * k; };
  for (int k = 0; k < 10; ++k) {
    const packs::Real solution[2] = {packs::Real(power(k)), packs::Real(1)};
    const packs::Real first = history.error<0>(solution, 0, 2);
    const packs::Real fourth = history.error<3>(solution, 0, 1);
    EXPECT_EQ(first[0], k == 0 ? 0 : power(k) - power(k - 1)) << k;
    if (k >= 4) {
      EXPECT_EQ(fourth[1], 24) << k;
    }
    if (k == 3) {
      EXPECT_EQ(fourth[1], 81 - 3 * 16 + 3) << k;
    }
    EXPECT_EQ((history.error<0>(solution, 1, 1)[0]), 0) << k;
    history.record(solution);
  }
}

TEST(LaneBlocks, WhatAProductLosesIsExact) {
  Numbers numbers;
  packs::Real x = 0;
  packs::Real y = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    x.set(lane, numbers.next() / 3);
    y.set(lane, std::exp(numbers.next()));
  }
  const packs::Real error = packs::product_error(x, y);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(error[lane], std::fma(x[lane], y[lane], -(x[lane] * y[lane])));
    EXPECT_EQ(error[lane], of_double::product_error(x[lane], y[lane]));
  }
}

TEST(LaneBlocks, WhatADifferenceLosesIsExact) {
  Numbers numbers;
  packs::Real x = 0;
  packs::Real y = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    x.set(lane, numbers.next() / 3);
    y.set(lane, std::exp(9 * numbers.next()));
  }
  const packs::Real error = packs::difference_error(x, y);
  for (int lane = 0; lane < kLanes; ++lane) {
    const __float128 exact = __float128(x[lane]) - y[lane];
    EXPECT_TRUE(error[lane] == static_cast<double>(exact - (x[lane] - y[lane])));
    EXPECT_EQ(error[lane], of_double::difference_error(x[lane], y[lane]));
  }
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
