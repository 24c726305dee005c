// Polynomials in one variable over the rationals, and their real roots: nothing here rounds.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "generator/algebra/exact.hpp"

namespace hamgen {

// Coefficients of 1, x, x^2, ..., the last not zero; empty for 0.
using RationalPolynomial = std::vector<Rational>;

[[nodiscard]] RationalPolynomial trimmed(RationalPolynomial p);
[[nodiscard]] int degree(const RationalPolynomial& p);  // -1 for 0
[[nodiscard]] Rational value_at(const RationalPolynomial& p, const Rational& x);
[[nodiscard]] RationalPolynomial sum_of(const RationalPolynomial& p, const RationalPolynomial& q);
[[nodiscard]] RationalPolynomial scaled_by(const Rational& c, RationalPolynomial p);
[[nodiscard]] RationalPolynomial product_of(const RationalPolynomial& p,
                                            const RationalPolynomial& q);
// The quotient, of which the remainder is left over.
[[nodiscard]] std::pair<RationalPolynomial, RationalPolynomial> divided(
    RationalPolynomial p, const RationalPolynomial& q);
// Times a positive number that makes the coefficients integers without a common factor.
[[nodiscard]] RationalPolynomial primitive(RationalPolynomial p);
[[nodiscard]] RationalPolynomial common_divisor(RationalPolynomial p, RationalPolynomial q);
// Factors without multiple roots, each with its multiplicity; their product is p times a constant.
[[nodiscard]] std::vector<std::pair<RationalPolynomial, int>> square_free_factors(
    const RationalPolynomial& p);
// The product of those factors, each once.
[[nodiscard]] RationalPolynomial square_free_part(const RationalPolynomial& p);

// The polynomial of degree below values.size() with these values at 1, 2, 3, ...: (x, value).
[[nodiscard]] RationalPolynomial interpolated(
    const std::vector<std::pair<Rational, Rational>>& points);

// How many different real roots a polynomial without multiple ones has with low < x < high; without
// an end, to infinity.  By Sturm's theorem.
[[nodiscard]] int count_roots(const RationalPolynomial& square_free,
                              const std::optional<Rational>& low,
                              const std::optional<Rational>& high);
// The different positive roots of any polynomial in ascending order, each alone between two
// numbers, low <= x <= high, that differ by less than 1e-14 of it.  By Descartes' rule of signs and
// bisection (Collins and Akritas, 1976).
[[nodiscard]] std::vector<std::pair<Rational, Rational>> positive_roots(
    const RationalPolynomial& p);

// A number between two others with few digits.
[[nodiscard]] Rational simple_between(const Rational& low, const Rational& high);

}  // namespace hamgen
