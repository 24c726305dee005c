#include "generator/verify/precise.hpp"

#include <cln/integer.h>
#include <cln/rational.h>
#include <ginac/ginac.h>

#include <array>
#include <stdexcept>
#include <vector>

#include "generator/algebra/from_ginac.hpp"
#include "generator/algebra/ginac_functions.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

// 60 digits, of which rounding takes a few.
constexpr long kPreciseDigits = 60;
const cln::float_format_t kFormat = cln::float_format(kPreciseDigits);

Precise to_float(const cln::cl_R& value) { return cln::cl_float(value, kFormat); }

void require(bool condition) {
  if (!condition) throw std::domain_error("outside the domain");
}

// A sum of larger numbers of which no digit is left: whether it is zero is not known.
struct LostDigits : std::domain_error {
  LostDigits() : std::domain_error("no digits are left") {}
};

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
  const Function* row = find_function(name);
  if (row == nullptr || x.size() != static_cast<std::size_t>(row->arity))
    internal_error("no precise value of the function " + name);
  if (name == "sqrt") return square_root_of(x[0]);
  require(!row->is_undefined_at_zero ||
          !std::ranges::all_of(x, [](const Precise& a) { return cln::zerop(a); }));
  // GiNaC rounds what it evaluates to this many digits; evaluate_function asks for more for a
  // while.
  if (static_cast<long>(GiNaC::Digits) != kPreciseDigits) GiNaC::Digits = kPreciseDigits;
  GiNaC::exvector arguments;
  for (const Precise& a : x) arguments.emplace_back(GiNaC::numeric(a));
  const GiNaC::ex value = GiNaC::function(ginac_serial(*row), arguments).evalf();
  require(GiNaC::is_a<GiNaC::numeric>(value));
  const auto& number = GiNaC::ex_to<GiNaC::numeric>(value);
  require(number.is_real());
  return to_float(cln::realpart(number.to_cl_N()));
}

Precise precise(const Rational& value) { return cln::cl_float(to_cln(value), kFormat); }

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
  if (over < 0 && cln::zerop(base.value) && !cln::zerop(base.scale)) throw LostDigits();
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

const std::array<Expression, 2>& places() {
  static const std::array<Expression, 2> symbols = {Expression::symbol("x", 0),
                                                    Expression::symbol("y", 1)};
  return symbols;
}

// The derivatives of the functions, by their arguments in places().
const std::vector<Expression>& slopes_of(const std::string& name) {
  static std::map<std::string, std::vector<Expression>> known;
  const auto [it, fresh] = known.try_emplace(name);
  if (!fresh) return it->second;
  for (const Function::Formula slope : find_function(name)->slopes) {
    if (slope != nullptr) it->second.push_back(slope(places()));
  }
  return it->second;
}

Precise plain_value(const Expression& e, const std::vector<Precise>& x);

Precise plain_power(const Precise& base, const Expression& exponent,
                    const std::vector<Precise>& x) {
  if (!exponent.is_number()) return power_of(base, plain_value(exponent, x));
  const Integer& over = exponent.number().get_num();
  const bool is_root = exponent.number().get_den() == 2;
  if ((!is_root && exponent.number().get_den() != 1) || !over.fits_slong_p())
    return power_of(base, precise(exponent.number()));
  return integer_power_of(is_root ? square_root_of(base) : base, over.get_si());
}

// With the arguments x in places().
Precise plain_value(const Expression& e, const std::vector<Precise>& x) {
  if (e.is_number()) return precise(e.number());
  if (e.kind() == Kind::symbol) return x.at(e == places()[0] ? 0 : 1);
  const auto operands = e.operands();
  if (e.kind() == Kind::power) return plain_power(plain_value(operands[0], x), operands[1], x);
  std::vector<Precise> values;
  for (const Expression& operand : operands) values.push_back(plain_value(operand, x));
  if (e.kind() == Kind::function) return precise_function(e.name(), values);
  Precise result = values[0];
  for (std::size_t i = 1; i < values.size(); ++i)
    result = e.kind() == Kind::sum ? result + values[i] : result * values[i];
  return result;
}

// Of a value itself, without its scale: 0 where it has none.
Precise size_of(const Expression& e, const std::vector<Precise>& x) {
  try {
    return cln::abs(plain_value(e, x));
  } catch (const std::domain_error&) {
    return zero();
  }
}

ScaledValue function_of(const std::string& name, const std::vector<ScaledValue>& x) {
  std::vector<Precise> arguments;
  for (const ScaledValue& a : x) arguments.push_back(a.value);
  const Precise value = precise_function(name, arguments);
  // Some are computed by way of numbers of size 1.
  const bool is_own_size = name == "abs" || name == "exp" || name == "sqrt";
  Precise scale = is_own_size ? cln::abs(value) : cln::abs(value) + precise(1);
  const std::vector<Expression>& slopes = slopes_of(name);
  for (std::size_t i = 0; i < x.size(); ++i)
    scale = scale + size_of(slopes[i], arguments) * x[i].scale;
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
  } catch (const LostDigits&) {
    lost_digits_ = true;
    return std::nullopt;
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

Precise value_of_exact(const Expression& e) {
  const Substitution none;
  return *PreciseValues({}, none)(e);
}

}  // namespace hamgen
