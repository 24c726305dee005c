#include "generator/verify/power_series.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "generator/algebra/functions.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

Precise coefficient(const PowerSeries& a, std::size_t k) {
  return k < a.size() ? a[k] : precise(0);
}

PowerSeries operator+(const PowerSeries& a, const PowerSeries& b) {
  PowerSeries result = a.size() < b.size() ? b : a;
  const PowerSeries& shorter = a.size() < b.size() ? a : b;
  for (std::size_t k = 0; k < shorter.size(); ++k) result[k] = result[k] + shorter[k];
  return result;
}

PowerSeries operator-(const PowerSeries& a) {
  PowerSeries result;
  for (const Precise& x : a) result.push_back(-x);
  return result;
}

PowerSeries operator-(const PowerSeries& a, const PowerSeries& b) { return a + (-b); }

PowerSeries operator*(const Precise& a, const PowerSeries& b) {
  PowerSeries result;
  for (const Precise& x : b) result.push_back(a * x);
  return result;
}

PowerSeries product(const PowerSeries& a, const PowerSeries& b, std::size_t length) {
  if (a.empty() || b.empty()) return {};
  PowerSeries result(std::min(a.size() + b.size() - 1, length), precise(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size() && i + j < result.size(); ++j) {
      result[i + j] = result[i + j] + a[i] * b[j];
    }
  }
  return result;
}

namespace {

Precise whole(std::size_t k) { return precise(Rational(static_cast<unsigned long>(k))); }

// How far a function of these arguments has terms: a function of constants is a constant.
std::size_t extent(const std::vector<PowerSeries>& x, std::size_t length) {
  return std::ranges::all_of(x, [](const PowerSeries& a) { return a.size() <= 1; }) ? 1 : length;
}

// w = u^c with  k u_0 w_k = sum over j = 1..k of (c j - (k - j)) u_j w_(k - j).
PowerSeries power(const PowerSeries& u, const Precise& c, const Precise& start,
                  std::size_t length) {
  PowerSeries w{start};
  for (std::size_t k = 1; k < extent({u}, length); ++k) {
    Precise sum = precise(0);
    for (std::size_t j = 1; j <= std::min(k, u.size() - 1); ++j) {
      sum = sum + (c * whole(j) - whole(k - j)) * u[j] * w[k - j];
    }
    w.push_back(sum / (whole(k) * u[0]));
  }
  return w;
}

PowerSeries integer_power(const PowerSeries& u, long n, std::size_t length) {
  PowerSeries result{precise(1)};
  for (long k = 0; k < n; ++k) result = product(result, u, length);
  return result;
}

// start + the integral of u' g.
PowerSeries integral(const Precise& start, const PowerSeries& u, const PowerSeries& g,
                     std::size_t length) {
  PowerSeries w{start};
  for (std::size_t k = 1; k < extent({u, g}, length); ++k) {
    Precise sum = precise(0);
    for (std::size_t j = 1; j <= std::min(k, u.size() - 1); ++j) {
      sum = sum + whole(j) * u[j] * coefficient(g, k - j);
    }
    w.push_back(sum / whole(k));
  }
  return w;
}

// f(x) = f(x_0) + the integral of x' f'(x), for which f'(x) is wanted up to one term less: that may
// contain f itself.
PowerSeries apply(const std::string& name, const std::vector<PowerSeries>& x, std::size_t length) {
  std::vector<Precise> first;
  for (const PowerSeries& a : x) first.push_back(coefficient(a, 0));
  // The argument is known to 60 digits: beyond 1e25 fewer than 35 are left of what is within a
  // period, too few for the 1e-30 that is asked of a series.
  static const Precise many = precise(*parse_decimal("1e25"));
  const Shape shape = find_function(name)->shape;
  const bool is_periodic =
      shape == Shape::sine || shape == Shape::cosine || shape == Shape::tangent;
  if (is_periodic && cln::abs(first[0]) > many) throw std::domain_error("periods beyond number");
  PowerSeries result{precise_function(name, first)};
  const std::size_t terms = extent(x, length);
  if (terms <= 1) return result;
  const std::array<Expression, 2> arguments = {Expression::symbol("x", 0),
                                               Expression::symbol("y", 1)};
  std::map<std::string, PowerSeries> shorter;
  for (std::size_t i = 0; i < x.size(); ++i) {
    PowerSeries head(x[i].begin(), x[i].begin() + std::min(x[i].size(), terms - 1));
    shorter[arguments.at(i).name()] = std::move(head);
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Expression slope = find_function(name)->slopes.at(i)(arguments);
    SeriesValues values(shorter, terms - 1);
    const auto along = values(slope);
    if (!along) throw std::domain_error("no power series of " + name);
    result = result + integral(precise(0), x[i], *along, terms);
  }
  return result;
}

}  // namespace

std::optional<PowerSeries> SeriesValues::operator()(const Expression& e) {
  try {
    return value(e);
  } catch (const std::domain_error&) {
    return std::nullopt;
  } catch (const cln::runtime_exception&) {  // overflow
    return std::nullopt;
  }
}

const PowerSeries& SeriesValues::value(const Expression& e) {
  const auto it = done_.find(e.identity());
  if (it != done_.end()) return it->second;
  kept_.push_back(e);
  PowerSeries result = computed(e);
  return done_.emplace(e.identity(), std::move(result)).first->second;
}

PowerSeries SeriesValues::computed(const Expression& e) {
  const auto operands = e.operands();
  switch (e.kind()) {
    case Kind::number:
      return {precise(e.number())};
    case Kind::symbol: {
      const auto it = symbols_.find(e.name());
      if (it != symbols_.end()) return it->second;
      if (e.name() != "pi") internal_error("no value of " + e.name());
      return {precise_function("pi", {})};
    }
    case Kind::sum: {
      PowerSeries sum = value(operands[0]);
      for (std::size_t i = 1; i < operands.size(); ++i) sum = sum + value(operands[i]);
      return sum;
    }
    case Kind::product: {
      PowerSeries result = value(operands[0]);
      for (std::size_t i = 1; i < operands.size(); ++i) {
        result = product(result, value(operands[i]), length_);
      }
      return result;
    }
    case Kind::power:
      return power_of(value(operands[0]), operands[1]);
    case Kind::function:
      break;
  }
  std::vector<PowerSeries> x;
  for (const Expression& operand : operands) x.push_back(value(operand));
  return apply(e.name(), x, length_);
}

PowerSeries SeriesValues::power_of(const PowerSeries& base, const Expression& exponent) {
  const Precise first = coefficient(base, 0);
  if (exponent.is_number() && exponent.number().get_den() <= 2 &&
      exponent.number().get_num().fits_slong_p()) {
    const bool integer = exponent.number().get_den() == 1;
    const long over = exponent.number().get_num().get_si();
    if (integer && over >= 0) return integer_power(base, over, length_);
    if (cln::zerop(first)) throw std::domain_error("a pole");
    const Precise root = integer ? first : precise_function("sqrt", {first});
    const Precise size = integer_power({root}, over < 0 ? -over : over, 1)[0];
    const Precise start = over < 0 ? cln::recip(size) : size;
    return power(base, precise(exponent.number()), start, length_);
  }
  return apply("exp", {product(value(exponent), apply("log", {base}, length_), length_)}, length_);
}

}  // namespace hamgen
