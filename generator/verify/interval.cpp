#include "generator/verify/interval.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "generator/algebra/functions.hpp"

namespace hamgen {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// std::nextafter towards infinity, without the call, which most of the time of a product went to.
double next_above(double x) {
  if (x == kInfinity) return x;
  if (x == 0) return std::numeric_limits<double>::denorm_min();
  const auto bits = std::bit_cast<std::int64_t>(x);
  return std::bit_cast<double>(x > 0 ? bits + 1 : bits - 1);
}
double next_below(double x) { return -next_above(-x); }

// One unit for a sum or a product; the library's functions are right to a few.
Interval outwards(double low, double high, int units = 1) {
  if (std::isnan(low) || std::isnan(high)) return {-kInfinity, kInfinity};
  for (int k = 0; k < units; ++k) {
    low = next_below(low);
    high = next_above(high);
  }
  return {low, high};
}

constexpr int kUnitsOfFunctions = 4;

// Empty where the function is not defined.
std::optional<Interval> between(double low, double high) {
  if (std::isnan(low) || std::isnan(high)) return std::nullopt;
  return outwards(low, high, kUnitsOfFunctions);
}

// A cosine is monotone between multiples of pi, of which these are within x.
Interval cosine(const Interval& x) {
  if (!(x.high - x.low < 6.0) || std::abs(x.high) > 1e9) return {-1.0, 1.0};
  Interval result = outwards(std::min(std::cos(x.low), std::cos(x.high)),
                             std::max(std::cos(x.low), std::cos(x.high)), kUnitsOfFunctions);
  const double turns = std::ceil(x.low / std::numbers::pi - 1e-9);
  for (double k = turns; k * std::numbers::pi <= x.high + 1e-9; k += 1.0)
    (std::fmod(std::abs(k), 2.0) < 0.5 ? result.high : result.low) =
        std::fmod(std::abs(k), 2.0) < 0.5 ? 1.0 : -1.0;
  return {std::max(result.low, -1.0), std::min(result.high, 1.0)};
}

std::optional<Interval> function_of(const std::string& name, const Interval& x) {
  const Function* row = find_function(name);
  if (row == nullptr) return std::nullopt;
  const auto value = [row](double t) { return row->numbers.real(t, 0.0); };
  const Interval half_pi = outwards(std::numbers::pi / 2, std::numbers::pi / 2);
  switch (row->shape) {
    case Shape::unknown:
      return std::nullopt;
    case Shape::ascending:
      return between(value(x.low), value(x.high));
    case Shape::descending:
      return between(value(x.high), value(x.low));
    case Shape::valley_at_zero: {
      const double least = x.holds(0.0) ? 0.0 : std::min(std::abs(x.low), std::abs(x.high));
      const double most = std::max(std::abs(x.low), std::abs(x.high));
      Interval result = outwards(value(least), value(most), kUnitsOfFunctions);
      result.low = std::max(result.low, value(0.0));
      return result;
    }
    case Shape::cosine:
      return cosine(x);
    case Shape::sine:
      return cosine(x - half_pi);
    case Shape::tangent:
      return cosine(x - half_pi) / cosine(x);
  }
  return std::nullopt;
}

std::optional<Interval> power_of(const Interval& base, const Expression& exponent) {
  if (!exponent.is_number() || !exponent.number().get_num().fits_slong_p()) return std::nullopt;
  const long over = exponent.number().get_num().get_si();
  if (exponent.number().get_den() == 1) return power(base, over);
  if (base.low < 0.0 || (over < 0 && base.low <= 0.0)) return std::nullopt;
  const double e = to_double(exponent.number());
  const Interval ends{std::pow(base.low, e), std::pow(base.high, e)};
  return outwards(std::min(ends.low, ends.high), std::max(ends.low, ends.high), kUnitsOfFunctions);
}

// Of no number: what the intervals of its operands make of it.
std::optional<Interval> value_of(const Expression& e, const std::vector<std::size_t>& operands,
                                 const std::vector<Interval>& values,
                                 const std::map<std::string, Interval>& symbols) {
  switch (e.kind()) {
    case Kind::symbol: {
      if (e.name() == "pi") return outwards(std::numbers::pi, std::numbers::pi);
      const auto value = symbols.find(e.name());
      return value == symbols.end() ? std::nullopt : std::optional(value->second);
    }
    case Kind::power:
      return power_of(values[operands.front()], e.operands()[1]);
    case Kind::function:
      return operands.size() == 1 ? function_of(e.name(), values[operands.front()]) : std::nullopt;
    case Kind::sum:
    case Kind::product: {
      Interval result = values[operands.front()];
      for (std::size_t i = 1; i < operands.size(); ++i) {
        const Interval& next = values[operands[i]];
        result = e.kind() == Kind::sum ? result + next : result * next;
      }
      return result;
    }
    default:
      return std::nullopt;
  }
}

}  // namespace

Interval operator+(const Interval& a, const Interval& b) {
  return outwards(a.low + b.low, a.high + b.high);
}

Interval operator-(const Interval& a, const Interval& b) {
  return outwards(a.low - b.high, a.high - b.low);
}

Interval operator*(const Interval& a, const Interval& b) {
  if ((a.low == 0.0 && a.high == 0.0) || (b.low == 0.0 && b.high == 0.0)) return {};
  const auto [low, high] =
      std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
  return outwards(low, high);
}

Interval operator/(const Interval& a, const Interval& b) {
  if (b.holds(0.0)) return {-kInfinity, kInfinity};
  return a * outwards(1.0 / b.high, 1.0 / b.low);
}

Interval power(const Interval& a, long n) {
  if (n < 0) return Interval(1.0) / power(a, -n);
  Interval result(1.0);
  for (long k = 0; k < n; ++k) result = result * a;
  if (n % 2 == 0 && n > 0) result.low = std::max(result.low, 0.0);
  return result;
}

Interval enclosing(const Rational& value) {
  const double near = to_double(value);
  return from_double(near) == value ? Interval(near) : outwards(near, near);
}

Enclosures::Enclosures(const std::vector<Expression>& of) {
  ExpressionMap<std::size_t> known;
  for (const Expression& e : of) results_.push_back(add(e, known));
}

std::size_t Enclosures::add(const Expression& e, ExpressionMap<std::size_t>& known) {
  if (const auto place = known.find(e); place != known.end()) return place->second;
  Part part{.of = e, .operands = {}, .value = {}};
  if (e.is_number()) {
    part.value = enclosing(e.number());
  } else if (e.kind() == Kind::power) {
    part.operands.push_back(add(e.operands().front(), known));
  } else if (e.kind() != Kind::symbol) {
    for (const Expression& operand : e.operands()) part.operands.push_back(add(operand, known));
  }
  parts_.push_back(std::move(part));
  return known[e] = parts_.size() - 1;
}

std::optional<std::vector<Interval>> Enclosures::at(
    const std::map<std::string, Interval>& symbols) const {
  std::vector<Interval> values;
  values.reserve(parts_.size());
  for (const Part& part : parts_) {
    const std::optional<Interval> value =
        part.of.is_number() ? part.value : value_of(part.of, part.operands, values, symbols);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  std::vector<Interval> result;
  for (const std::size_t place : results_) result.push_back(values[place]);
  return result;
}

}  // namespace hamgen
