// Intervals of doubles that hold every value an expression takes: each operation rounds outwards.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

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

// Expressions of which the values are enclosed over and over: what they share is so once each time,
// and their numbers beforehand.
class Enclosures {
 public:
  explicit Enclosures(const std::vector<Expression>& of);
  // The values of each where the symbols are in these intervals; empty where one is not defined
  // everywhere there, or a function in it has no enclosure here.
  [[nodiscard]] std::optional<std::vector<Interval>> at(
      const std::map<std::string, Interval>& symbols) const;

 private:
  struct Part {
    Expression of;
    std::vector<std::size_t> operands;  // a power's base alone; none of numbers and symbols
    Interval value;                     // of a number
  };
  std::size_t add(const Expression& e, ExpressionMap<std::size_t>& known);
  std::vector<Part> parts_;  // operands before what is made of them
  std::vector<std::size_t> results_;
};

}  // namespace hamgen
