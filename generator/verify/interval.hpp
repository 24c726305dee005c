// Intervals of doubles that hold every value an expression takes: each operation rounds outwards.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "generator/algebra/expression.hpp"

namespace hamgen {

struct Interval {
  double low = 0.0;
  double high = 0.0;
  Interval() = default;
  Interval(double value) : low(value), high(value) {}  // NOLINT: numbers are intervals
  Interval(double from, double to) : low(from), high(to) {}
  [[nodiscard]] bool holds(double x) const { return low <= x && x <= high; }
  // False too for one that is not finite.
  [[nodiscard]] bool is_above(double x) const { return low > x; }
  [[nodiscard]] bool is_below(double x) const { return high < x; }
};

[[nodiscard]] Interval operator+(const Interval& a, const Interval& b);
[[nodiscard]] Interval operator-(const Interval& a, const Interval& b);
[[nodiscard]] Interval operator*(const Interval& a, const Interval& b);
// All numbers where b holds 0.
[[nodiscard]] Interval operator/(const Interval& a, const Interval& b);
[[nodiscard]] Interval power(const Interval& a, long n);
// Around the rational number.
[[nodiscard]] Interval enclosing(const Rational& value);

// The values of an expression where its symbols are in these intervals; empty where it is not
// defined everywhere there, or a function of it has no enclosure here.
[[nodiscard]] std::optional<Interval> enclosure(const Expression& e,
                                                const std::map<std::string, Interval>& symbols);

}  // namespace hamgen
