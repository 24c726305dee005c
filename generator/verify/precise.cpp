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
  if (name == "asinh") return to_float(cln::ln(a + cln::sqrt(a * a + one)));
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

Precise random_precise(std::mt19937_64& source) {
  const Rational step(static_cast<unsigned long>(source() >> 32), 4294967296UL);
  Rational value = Rational(1, 4) + Rational(3, 2) * step;
  value.canonicalize();
  return precise(value);
}

std::optional<Precise> PreciseValues::operator()(const Expression& e) {
  try {
    return value(e);
  } catch (const std::domain_error&) {
    return std::nullopt;
  } catch (const cln::runtime_exception&) {  // overflow
    return std::nullopt;
  }
}

Precise PreciseValues::symbol(const std::string& name) {
  if (const auto it = values_.find(name); it != values_.end()) return it->second;
  if (name == "pi") return precise_function(name, {});
  const auto definition = definitions_.find(name);
  if (definition == definitions_.end()) internal_error("no value of " + name);
  const Precise result = value(definition->second);
  values_.emplace(name, result);
  return result;
}

Precise PreciseValues::value(const Expression& e) {
  if (e.is_number()) return precise(e.number());
  if (e.kind() == Kind::symbol) return symbol(e.name());
  if (const auto it = done_.find(e.identity()); it != done_.end()) return it->second.second;
  Precise result;
  if (e.kind() == Kind::power && e.operands()[1].is_number()) {
    const Rational& exponent = e.operands()[1].number();
    const Precise base = value(e.operands()[0]);
    const Integer& over = exponent.get_num();
    if (exponent.get_den() == 1 && over.fits_slong_p()) {
      result = integer_power_of(base, over.get_si());
    } else if (exponent.get_den() == 2 && over.fits_slong_p()) {
      result = integer_power_of(square_root_of(base), over.get_si());
    } else {
      result = power_of(base, precise(exponent));
    }
  } else {
    std::vector<Precise> operands;
    for (const Expression& operand : e.operands()) operands.push_back(value(operand));
    switch (e.kind()) {
      case Kind::sum:
        result = operands[0];
        for (std::size_t i = 1; i < operands.size(); ++i) result = result + operands[i];
        break;
      case Kind::product:
        result = operands[0];
        for (std::size_t i = 1; i < operands.size(); ++i) result = result * operands[i];
        break;
      case Kind::power:
        result = power_of(operands[0], operands[1]);
        break;
      case Kind::function:
        result = precise_function(e.name(), operands);
        break;
      case Kind::number:
      case Kind::symbol:
        internal_error("handled above");
    }
  }
  done_.emplace(e.identity(), std::pair(e, result));
  return result;
}

}  // namespace hamgen
