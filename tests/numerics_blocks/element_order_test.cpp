// Linear systems whose unknowns stand in another order than that of the state.
#include <cmath>

#include "tests/numerics_blocks/linear_systems.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class Orders : public Matrices<Blocks> {};
TYPED_TEST_SUITE(Orders, EveryScalar);

template <class Order>
std::vector<int> rows_of(int count) {
  std::vector<int> rows;
  for (int i = 0; i < count; ++i) rows.push_back(Order::row(i));
  return rows;
}

TYPED_TEST(Orders, UnknownsOfSeveralArraysStandElementByElement) {
  EXPECT_EQ((rows_of<typename TypeParam::template Order<2, 3, false>>(6)),
            (std::vector<int>{0, 2, 4, 1, 3, 5}));
  EXPECT_EQ((rows_of<typename TypeParam::template Order<1, 5, true>>(5)),
            (std::vector<int>{0, 2, 4, 3, 1}));
  EXPECT_EQ((rows_of<typename TypeParam::template Order<2, 4, true>>(8)),
            (std::vector<int>{0, 4, 6, 2, 1, 5, 7, 3}));
  // What is behind the arrays stays there.
  EXPECT_EQ((rows_of<typename TypeParam::template Order<2, 3, false>>(7)),
            (std::vector<int>{0, 2, 4, 1, 3, 5, 6}));
  // A border stands behind all others: of two arrays of three with a variable behind each, and of
  // one array with t behind it.
  EXPECT_EQ((rows_of<typename TypeParam::template OrderOfBorder<6, 2, 3, false, 3, 7>>(8)),
            (std::vector<int>{0, 2, 4, 6, 1, 3, 5, 7}));
  EXPECT_EQ((rows_of<typename TypeParam::template OrderOfBorder<4, 1, 3, false, 0>>(5)),
            (std::vector<int>{4, 0, 1, 2, 3}));
}

// The band with zeros on its diagonal, the corner with zeros everywhere.
TYPED_TEST(Orders, ABorderOfFullRowsAndColumnsIsEliminatedAfterTheBand) {
  using Real = typename TypeParam::Scalar;
  using Band = typename TypeParam::template Band<6, 1>;
  Numbers numbers;
  typename TypeParam::template Bordered<Band, 2> bordered;
  typename TypeParam::template Reordered<
      typename TypeParam::template Bordered<Band, 2>,
      typename TypeParam::template OrderOfBorder<6, 1, 6, false, 0, 3>>
      reordered;
  const auto unknown = [](int row) { return row < 6 ? row + (row < 2 ? 1 : 2) : 3 * (row - 6); };
  for (int run = 0; run < 20; ++run) {
    Real entry[8][8] = {};
    Real moved[8][8] = {};
    for (int i = 0; i < 8; ++i) {
      for (int j = 0; j < 8; ++j) {
        const bool inside = i < 6 && j < 6 && (i - j == 1 || j - i == 1);
        const bool border = (i < 6) != (j < 6);
        entry[i][j] = inside || border ? Real(numbers.next()) : Real(0);
        moved[unknown(i)][unknown(j)] = entry[i][j];
      }
    }
    const double error = this->template error<8>(bordered, entry);
    EXPECT_GE(error, 0);
    EXPECT_LT(error, 20000) << run;
    const double again = this->template error<8>(reordered, moved);
    EXPECT_GE(again, 0);
    EXPECT_LT(again, 20000) << run;
  }
  // What is inside is singular, and the border holds it.
  Real held[8][8] = {};
  for (int i = 0; i < 6; ++i) held[i][i] = i == 3 ? Real(0) : Real(1);
  held[3][6] = held[6][3] = held[7][7] = 1;
  // A solve errs by the root of a unit.
  const double of_held = this->template error<8>(bordered, held);
  EXPECT_GE(of_held, 0);
  EXPECT_LT(of_held, 16 / std::sqrt(static_cast<double>(TypeParam::unit)));
  // A border that is nothing but zeros.
  Real entry[8][8] = {};
  for (int i = 0; i < 6; ++i) entry[i][i] = 1;
  EXPECT_EQ(this->template error<8>(bordered, entry), -1);
}

// Folded flat it has its neighbours within two places: 0, 7, 1, 6, 2, 5, 3, 4.
TYPED_TEST(Orders, ARingIsABandInAnotherOrder) {
  using Real = typename TypeParam::Scalar;
  Numbers numbers;
  typename TypeParam::template Reordered<typename TypeParam::template Band<8, 2>,
                                         typename TypeParam::template Order<1, 8, true>>
      ring;
  for (int run = 0; run < 20; ++run) {
    Real entry[8][8] = {};
    for (int i = 0; i < 8; ++i) {
      entry[i][i] = 3;
      entry[i][(i + 1) % 8] = Real(numbers.next());
      entry[(i + 1) % 8][i] = Real(numbers.next());
    }
    const double error = this->template error<8>(ring, entry);
    EXPECT_GE(error, 0);
    EXPECT_LT(error, 100) << run;
  }
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
