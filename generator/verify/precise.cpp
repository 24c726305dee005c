#include "generator/verify/precise.hpp"

#include <cln/integer.h>
#include <cln/rational.h>

#include <stdexcept>
#include <vector>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

// 60 digits, of which rounding takes a few.
const cln::float_format_t kFormat = cln::float_format(60);

Precise to_float(const cln::cl_R& value) { return cln::cl_float(value, kFormat); }

void require(bool condition) {
  if (!condition) throw std::domain_error("outside the domain");
}

Precise square_root_of(const Precise& x) {
  require(!cln::minusp(x));
  return to_float(cln::sqrt(x));
}

Precise integer_power_of(const Precise& x, long n) {
  if (n == 0) return precise(1);
  require(n > 0 || !cln::zerop(x));
  const Precise size = to_float(cln::expt(x, cln::cl_I(n < 0 ? -n : n)));
  return n < 0 ? cln::recip(size) : size;
}

Precise power_of(const Precise& base, const Precise& exponent) {
  require(cln::plusp(base));
  return cln::exp(exponent * cln::ln(base));
}

}  // namespace

Precise precise_function(const std::string& name, const std::vector<Precise>& x) {
  if (name == "pi") return cln::pi(kFormat);
  const Precise& a = x.front();
  const Precise one = precise(1);
  auto arc_tangent = [](const Precise& over, const Precise& under) {
    require(!cln::zerop(over) || !cln::zerop(under));
    return to_float(cln::atan(under, over));  // CLN has the abscissa first
  };
  if (name == "abs") return cln::abs(a);
  if (name == "sin") return cln::sin(a);
  if (name == "cos") return cln::cos(a);
  if (name == "tan") return cln::tan(a);
  if (name == "exp") return cln::exp(a);
  if (name == "sinh") return cln::sinh(a);
  if (name == "cosh") return cln::cosh(a);
  if (name == "tanh") return cln::tanh(a);
  if (name == "sqrt") return square_root_of(a);
  if (name == "log") {
    require(cln::plusp(a));
    return to_float(cln::ln(a));
  }
  if (name == "atan") return arc_tangent(a, one);
  if (name == "atan2") return arc_tangent(a, x.at(1));
  if (name == "asin") return arc_tangent(a, square_root_of(one - a * a));
  if (name == "acos") return arc_tangent(square_root_of(one - a * a), a);
  if (name == "asinh") {  // odd, and without cancellation for a > 0
    const Precise size = to_float(cln::ln(cln::abs(a) + cln::sqrt(a * a + one)));
    return cln::minusp(a) ? -size : size;
  }
  if (name == "acosh") {
    require(a >= one);
    return to_float(cln::ln(a + square_root_of(a * a - one)));
  }
  if (name == "atanh") {
    require(cln::abs(a) < one);
    return to_float(cln::ln((one + a) / (one - a))) / precise(2);
  }
  internal_error("no precise value of the function " + name);
}

Precise precise(const Rational& value) {
  const cln::cl_I over(value.get_num().get_str().c_str());
  const cln::cl_I under(value.get_den().get_str().c_str());
  return cln::cl_float(over / under, kFormat);
}

double to_double(const Precise& value) { return cln::double_approx(value); }

namespace {

const Precise& zero() {
  static const Precise value = precise(0);
  return value;
}

ScaledValue added(const ScaledValue& a, const ScaledValue& b) {
  return {a.value + b.value, a.scale + b.scale};
}

ScaledValue multiplied(const ScaledValue& a, const ScaledValue& b) {
  return {a.value * b.value, a.scale * cln::abs(b.value) + b.scale * cln::abs(a.value)};
}

// b^x for a constant x: the scale is multiplied by the derivative.
ScaledValue power_by(const ScaledValue& base, const Rational& exponent) {
  const Integer& over = exponent.get_num();
  Precise value;
  if (exponent.get_den() == 1 && over.fits_slong_p()) {
    value = integer_power_of(base.value, over.get_si());
  } else if (exponent.get_den() == 2 && over.fits_slong_p()) {
    value = integer_power_of(square_root_of(base.value), over.get_si());
  } else {
    value = power_of(base.value, precise(exponent));
  }
  if (cln::zerop(base.value)) return {value, base.scale + cln::abs(value)};
  const Precise slope = cln::abs(precise(exponent) * value / base.value);
  return {value, slope * base.scale + cln::abs(value)};
}

ScaledValue general_power(const ScaledValue& base, const ScaledValue& exponent) {
  const Precise value = power_of(base.value, exponent.value);
  const Precise of_base = cln::abs(exponent.value / base.value) * base.scale;
  const Precise of_exponent = cln::abs(cln::ln(base.value)) * exponent.scale;
  return {value, cln::abs(value) * (precise(1) + of_base + of_exponent)};
}

// |f'(x)| of a function with one argument, or a bound of it; y = f(x).
Precise slope_of(const std::string& name, const Precise& x, const Precise& y) {
  const Precise one = precise(1);
  const auto reciprocal = [](const Precise& d) { return cln::zerop(d) ? zero() : cln::recip(d); };
  if (name == "tan") return one + y * y;
  if (name == "exp") return cln::abs(y);
  if (name == "sinh" || name == "cosh") return one + cln::abs(y);
  if (name == "sqrt") return reciprocal(y + y);
  if (name == "log") return cln::abs(reciprocal(x));
  if (name == "asin" || name == "acos") return reciprocal(square_root_of(cln::abs(one - x * x)));
  if (name == "acosh") return reciprocal(square_root_of(cln::abs(x * x - one)));
  if (name == "atanh") return cln::abs(reciprocal(one - x * x));
  return one;  // abs, sin, cos, tanh, atan, asinh
}

ScaledValue function_of(const std::string& name, const std::vector<ScaledValue>& x) {
  std::vector<Precise> arguments;
  for (const ScaledValue& a : x) arguments.push_back(a.value);
  const Precise value = precise_function(name, arguments);
  // Some are computed by way of numbers of size 1.
  const bool is_own_size = name == "abs" || name == "exp" || name == "sqrt";
  Precise scale = is_own_size ? cln::abs(value) : cln::abs(value) + precise(1);
  if (x.size() == 1) {
    scale = scale + slope_of(name, x[0].value, value) * x[0].scale;
  } else {
    const Precise square = x[0].value * x[0].value + x[1].value * x[1].value;
    const Precise a = cln::abs(x[0].value) * x[1].scale;
    scale = scale + (a + cln::abs(x[1].value) * x[0].scale) / square;
  }
  return {value, scale};
}

}  // namespace

bool is_zero(const ScaledValue& x) {
  static const Precise tolerance = precise(*parse_decimal("1e-40"));
  return cln::abs(x.value) <= tolerance * x.scale;
}

ScaledValue operator-(const ScaledValue& a, const ScaledValue& b) {
  return {a.value - b.value, a.scale + b.scale};
}

PreciseValues::PreciseValues(const std::map<std::string, Precise>& free,
                             const Substitution& definitions)
    : definitions_(definitions) {
  for (const auto& [name, value] : free) values_[name] = {value, cln::abs(value)};
}

std::optional<ScaledValue> PreciseValues::scaled(const Expression& e) {
  try {
    return value(e);
  } catch (const std::domain_error&) {
    return std::nullopt;
  } catch (const cln::runtime_exception&) {  // overflow
    return std::nullopt;
  }
}

std::optional<Precise> PreciseValues::operator()(const Expression& e) {
  const std::optional<ScaledValue> result = scaled(e);
  if (!result) return std::nullopt;
  return result->value;
}

ScaledValue PreciseValues::symbol(const std::string& name) {
  if (const auto it = values_.find(name); it != values_.end()) return it->second;
  if (name == "pi") {
    const Precise pi = precise_function(name, {});
    return {pi, pi};
  }
  const auto definition = definitions_.find(name);
  if (definition == definitions_.end()) internal_error("no value of " + name);
  ScaledValue result = value(definition->second);
  values_.emplace(name, result);
  return result;
}

ScaledValue PreciseValues::value(const Expression& e) {
  if (e.is_number()) {
    const Precise number = precise(e.number());
    return {number, cln::abs(number)};
  }
  if (e.kind() == Kind::symbol) return symbol(e.name());
  if (const auto it = done_.find(e.identity()); it != done_.end()) return it->second.second;
  ScaledValue result = computed(e);
  done_.emplace(e.identity(), std::pair(e, result));
  return result;
}

ScaledValue PreciseValues::computed(const Expression& e) {
  if (e.kind() == Kind::power && e.operands()[1].is_number())
    return power_by(value(e.operands()[0]), e.operands()[1].number());
  std::vector<ScaledValue> operands;
  for (const Expression& operand : e.operands()) operands.push_back(value(operand));
  ScaledValue result = operands.front();
  switch (e.kind()) {
    case Kind::sum:
      for (std::size_t i = 1; i < operands.size(); ++i) result = added(result, operands[i]);
      return result;
    case Kind::product:
      for (std::size_t i = 1; i < operands.size(); ++i) result = multiplied(result, operands[i]);
      return result;
    case Kind::power:
      return general_power(operands[0], operands[1]);
    case Kind::function:
      return function_of(e.name(), operands);
    case Kind::number:
    case Kind::symbol:
      break;
  }
  internal_error("handled above");
}

}  // namespace hamgen
