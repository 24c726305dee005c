#include "tests/random/jet.hpp"

#include <quadmath.h>

#include <functional>
#include <map>

namespace hamgen::random {
namespace {

// a x' + b y'
Vector combined(Quad a, const Vector& x, Quad b, const Vector& y) {
  Vector result(std::max(x.size(), y.size()));
  for (std::size_t i = 0; i < x.size(); ++i) result[i] += a * x[i];
  for (std::size_t i = 0; i < y.size(); ++i) result[i] += b * y[i];
  return result;
}

Jet chain(Quad value, Quad slope, const Jet& x) {
  return {value, combined(slope, x.gradient, 0, {})};
}

struct Rule {
  Quad (*value)(Quad);
  std::function<Quad(Quad)> slope;
};

const std::map<std::string, Rule>& rules() {
  static const std::map<std::string, Rule> table = {
      {"abs", {fabsq, [](Quad x) { return Quad(x < 0 ? -1 : 1); }}},
      {"acos", {acosq, [](Quad x) { return -1 / sqrtq(1 - x * x); }}},
      {"acosh", {acoshq, [](Quad x) { return 1 / sqrtq(x * x - 1); }}},
      {"asin", {asinq, [](Quad x) { return 1 / sqrtq(1 - x * x); }}},
      {"asinh", {asinhq, [](Quad x) { return 1 / sqrtq(x * x + 1); }}},
      {"atan", {atanq, [](Quad x) { return 1 / (1 + x * x); }}},
      {"atanh", {atanhq, [](Quad x) { return 1 / (1 - x * x); }}},
      {"cos", {cosq, [](Quad x) { return -sinq(x); }}},
      {"cosh", {coshq, [](Quad x) { return sinhq(x); }}},
      {"exp", {expq, [](Quad x) { return expq(x); }}},
      {"expm1", {expm1q, [](Quad x) { return expq(x); }}},
      {"log", {logq, [](Quad x) { return 1 / x; }}},
      {"log1p", {log1pq, [](Quad x) { return 1 / (1 + x); }}},
      {"sin", {sinq, [](Quad x) { return cosq(x); }}},
      {"sinh", {sinhq, [](Quad x) { return coshq(x); }}},
      {"sqrt", {sqrtq, [](Quad x) { return 1 / (2 * sqrtq(x)); }}},
      {"tan", {tanq, [](Quad x) { return 1 + tanq(x) * tanq(x); }}},
      {"tanh", {tanhq, [](Quad x) { return 1 - tanhq(x) * tanhq(x); }}},
  };
  return table;
}

// x^n from the left, exact for what repeated products are exact for.
Quad integer_power(Quad x, long n) {
  Quad result = 1;
  for (long i = n < 0 ? -n : n; i > 0; --i) result *= x;
  return n < 0 ? 1 / result : result;
}

}  // namespace

Jet operator+(const Jet& x, const Jet& y) {
  return {x.value + y.value, combined(1, x.gradient, 1, y.gradient)};
}
Jet operator-(const Jet& x, const Jet& y) {
  return {x.value - y.value, combined(1, x.gradient, -1, y.gradient)};
}
Jet operator*(const Jet& x, const Jet& y) {
  return {x.value * y.value, combined(y.value, x.gradient, x.value, y.gradient)};
}
Jet operator/(const Jet& x, const Jet& y) {
  const Quad value = x.value / y.value;
  return {value, combined(1 / y.value, x.gradient, -value / y.value, y.gradient)};
}

// d(b^e) = e b^(e-1) db + b^e log(b) de
Jet power(const Jet& base, const Jet& exponent) {
  const Quad e = exponent.value;
  if (exponent.gradient.empty()) {
    const long n = lrintq(e);
    if (e == 0) return {1};
    if (e == n)
      return chain(integer_power(base.value, n), e * integer_power(base.value, n - 1), base);
    return chain(powq(base.value, e), e * powq(base.value, e - 1), base);
  }
  const Quad value = powq(base.value, e);
  return {value, combined(e * powq(base.value, e - 1), base.gradient, value * logq(base.value),
                          exponent.gradient)};
}

Jet apply_function(const std::string& function, const std::vector<Jet>& arguments) {
  const Jet& x = arguments.at(0);
  if (function == "atan2") {
    // atan2(y, x): (x dy - y dx)/(x^2 + y^2)
    const Jet& over = arguments.at(1);
    const Quad square = x.value * x.value + over.value * over.value;
    return {atan2q(x.value, over.value),
            combined(over.value / square, x.gradient, -x.value / square, over.gradient)};
  }
  const Rule& rule = rules().at(function);
  if (x.gradient.empty()) return {rule.value(x.value)};
  return chain(rule.value(x.value), rule.slope(x.value), x);
}

}  // namespace hamgen::random
