// Exact roots, ranks and powers: what linear stability rests on.
#include "generator/verify/real_roots.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "generator/verify/bounded_powers.hpp"

namespace hamgen {
namespace {

RationalPolynomial with_roots(const std::vector<Rational>& roots) {
  RationalPolynomial p{Rational(1)};
  for (const Rational& root : roots) p = product_of(p, {-root, Rational(1)});
  return p;
}

TEST(PositiveRoots, AreAllFoundWhereverTheyLie) {
  std::mt19937_64 source(5);
  for (int i = 0; i < 100; ++i) {
    std::vector<Rational> roots;
    for (int k = 0; k < 6; ++k) {
      Rational root(static_cast<long>(source() % 2001) - 1000,
                    static_cast<long>(source() % 64) + 1);
      root.canonicalize();
      roots.push_back(root);
      if (source() % 3 == 0) roots.push_back(root);  // a double one
    }
    const RationalPolynomial p = product_of(with_roots(roots), {Rational(3), 0, Rational(7)});
    std::ranges::sort(roots);
    roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
    std::erase_if(roots, [](const Rational& x) { return x <= 0; });
    const auto found = positive_roots(p);
    ASSERT_EQ(found.size(), roots.size());
    for (std::size_t k = 0; k < roots.size(); ++k) {
      EXPECT_LE(found[k].first, roots[k]);
      EXPECT_GE(found[k].second, roots[k]);
      EXPECT_LE(found[k].second - found[k].first, roots[k] * *parse_decimal("1.0001e-14"));
    }
    // Sturm counts the same.
    EXPECT_EQ(count_roots(square_free_part(p), Rational(0), std::nullopt),
              static_cast<int>(roots.size()));
  }
}

// Two that differ by 1e-30, and the ends of the intervals that are looked at.
TEST(PositiveRoots, AreToldApartAtAnyDistance) {
  const Rational near = 2 + *parse_decimal("1e-30");
  EXPECT_EQ(positive_roots(with_roots({2, near, 4, Rational(1, 1024)})).size(), 4U);
  EXPECT_EQ(positive_roots({Rational(-2), 0, Rational(1)}).size(), 1U);
  EXPECT_TRUE(positive_roots({Rational(2), 0, Rational(1)}).empty());
  EXPECT_TRUE(positive_roots({Rational(0), 0, Rational(5)}).empty());
}

TEST(CountOfRoots, LeavesOutTheEnds) {
  const RationalPolynomial p = with_roots({-2, 0, 1, 2});
  EXPECT_EQ(count_roots(p, Rational(-2), Rational(2)), 2);
  EXPECT_EQ(count_roots(p, std::nullopt, std::nullopt), 4);
  EXPECT_EQ(count_roots(p, Rational(-3), Rational(3)), 4);
}

TEST(SquareFreeFactors, HaveTheMultiplicities) {
  const auto factors = square_free_factors(with_roots({1, 2, 2, 3, 3, 3, 4}));
  ASSERT_EQ(factors.size(), 3U);
  EXPECT_EQ(factors[0].first, with_roots({1, 4}));
  EXPECT_EQ(factors[2], std::pair(with_roots({3}), 3));
}

TEST(Interpolation, GivesThePolynomialBack) {
  const RationalPolynomial p{Rational(3), Rational(-1, 7), 0, Rational(5)};
  std::vector<std::pair<Rational, Rational>> points;
  for (long x = 1; x <= 6; ++x) points.emplace_back(x, value_at(p, Rational(x)));
  EXPECT_EQ(interpolated(points), p);
}

ExactMatrix matrix(std::size_t size, const std::vector<Rational>& entries) {
  return {size, entries};
}

// Rotations by exact angles, equal and different, with and without a Jordan block.
TEST(Powers, OfEqualFrequenciesAreHarmlessAndOfAJordanBlockAreNot) {
  const Rational c(3, 5);
  const Rational s(4, 5);
  const auto both = [&](const Rational& coupling) {
    // diag(R, R) in (q1, q2, p1, p2), times a shear that is symplectic and commutes with neither.
    ExactMatrix rotation = matrix(4, {c, 0, s, 0, 0, c, 0, s, -s, 0, c, 0, 0, -s, 0, c});
    // Rotation of the plane (q1, q2) together with (p1, p2): J S with S = x v - y u.
    ExactMatrix turned = matrix(4, {c, s, 0, 0, -s, c, 0, 0, 0, 0, c, s, 0, 0, -s, c});
    if (coupling == 0) return rotation;
    ExactMatrix kick = ExactMatrix::identity(4);
    kick(2, 0) = kick(3, 1) = -coupling;
    return turned * kick;
  };
  EXPECT_EQ(powers_of(both(0), 0, true), Powers::bounded);
  EXPECT_EQ(powers_of(both(Rational(1, 10)), 0, true), Powers::resonant);
  const ExactMatrix shear = matrix(2, {1, 1, 0, 1});
  EXPECT_EQ(powers_of(shear, 0, true), Powers::resonant);
  EXPECT_EQ(powers_of(shear, 1, true), Powers::bounded);  // a free motion
  EXPECT_EQ(powers_of(matrix(2, {-1, 0, 0, -1}), 0, true), Powers::bounded);
  EXPECT_EQ(powers_of(matrix(2, {-1, 1, 0, -1}), 0, true), Powers::resonant);
  EXPECT_EQ(powers_of(matrix(2, {2, 0, 0, Rational(1, 2)}), 0, true), Powers::growing);
  // No symplectic matrix: nothing is said.
  EXPECT_EQ(powers_of(matrix(2, {1, 0, 0, 2}), 0, true), Powers::undecided);
}

}  // namespace
}  // namespace hamgen
