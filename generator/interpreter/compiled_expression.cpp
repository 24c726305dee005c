#include "generator/interpreter/compiled_expression.hpp"

#include <quadmath.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <type_traits>

#include "generator/algebra/functions.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/interpreter/lane_functions.hpp"
#include "generator/interpreter/numerics.hpp"

namespace hamgen {

namespace {

using Quad = NumericValues::Quad;

template <class Real>
struct OfScalar;
template <>
struct OfScalar<float> {
  static NumericFunction<float> function(const NumericValues& all) { return all.single; }
  static float power(float x, float y) { return std::pow(x, y); }
};
template <>
struct OfScalar<double> {
  static NumericFunction<double> function(const NumericValues& all) { return all.real; }
  static double power(double x, double y) { return std::pow(x, y); }
};
template <>
struct OfScalar<long double> {
  static NumericFunction<long double> function(const NumericValues& all) { return all.extended; }
  static long double power(long double x, long double y) { return std::pow(x, y); }
};
template <>
struct OfScalar<Quad> {
  static NumericFunction<Quad> function(const NumericValues& all) { return all.quad; }
  static Quad power(Quad x, Quad y) { return powq(x, y); }
};

template <class Real>
constexpr int kDigits = std::numeric_limits<Real>::digits;
template <>
constexpr int kDigits<Quad> = FLT128_MANT_DIG;

}  // namespace

template <class Real>
NumericFunction<Real> numeric_function(const std::string& name, FunctionsOf functions) {
  if constexpr (std::is_same_v<Real, double>) {
    const bool of_lanes = functions == FunctionsOf::lanes;
    if (const auto own = of_lanes ? lane_function(name) : nullptr; own != nullptr) return own;
  }
  if (name == "pow") return OfScalar<Real>::power;
  if (name == kProductError) return NumericsOf<Real>::lost_of_product;
  if (name == kDifferenceError) return NumericsOf<Real>::lost_of_difference;
  if (const Function* row = find_function(name)) return OfScalar<Real>::function(row->numbers);
  internal_error("no number for the function " + name);
}

template <class Real>
Real nearest_number(const Rational& value) {
  if (value == 0) return 0;
  // size = mantissa 2^exponent with one bit more than the type has, and what is cut off in `rest`.
  const Rational size = abs(value);
  const auto bits = [](const Integer& x) {
    return static_cast<long>(mpz_sizeinbase(x.get_mpz_t(), 2));
  };
  long exponent = bits(size.get_num()) - bits(size.get_den()) - kDigits<Real> - 1;
  Integer over = size.get_num();
  Integer under = size.get_den();
  (exponent < 0 ? over : under) <<= static_cast<unsigned long>(std::labs(exponent));
  Integer mantissa;
  Integer rest;
  mpz_fdiv_qr(mantissa.get_mpz_t(), rest.get_mpz_t(), over.get_mpz_t(), under.get_mpz_t());
  const long extra = bits(mantissa) - kDigits<Real>;
  const Integer unit = Integer(1) << static_cast<unsigned long>(extra);
  const Integer tail = mantissa % unit;
  mantissa >>= static_cast<unsigned long>(extra);
  exponent += extra;
  const int side = cmp(2 * tail, unit);
  if (side > 0 || (side == 0 && (rest != 0 || mpz_odd_p(mantissa.get_mpz_t()) != 0))) ++mantissa;
  Real result = 0;
  for (long shift = 96; shift >= 0; shift -= 32) {
    const Integer limb = (mantissa >> static_cast<unsigned long>(shift)) & Integer(0xffffffffUL);
    result = result * Real(4294967296.0) + Real(limb.get_d());
  }
  const Real factor = exponent < 0 ? Real(0.5) : Real(2);
  for (long i = std::labs(exponent); i > 0; --i) result *= factor;
  return value < 0 ? -result : result;
}

template <class Real>
CompiledExpression<Real>::CompiledExpression(const Expression& e, const Resolve& resolve,
                                             FunctionsOf functions) {
  add(arrange(e), resolve, functions);
  stack_.resize(steps_.size());
}

template <class Real>
void CompiledExpression<Real>::add(const Arithmetic& a, const Resolve& resolve,
                                   FunctionsOf functions) {
  for (const Arithmetic& operand : a.operands) add(operand, resolve, functions);
  Step step{.operation = a.operation};
  if (a.operation == Operation::number) step.number = nearest_number<Real>(a.number);
  if (a.operation == Operation::symbol) step.address = resolve(a.name);
  if (a.operation == Operation::call) {
    step.function = numeric_function<Real>(a.name, functions);
    step.two_arguments = a.operands.size() == 2;
  }
  steps_.push_back(std::move(step));
}

template <class Real>
Real CompiledExpression<Real>::operator()(const Frame<Real>& frame) const {
  Real* top = stack_.data() - 1;
  for (const Step& step : steps_) {
    switch (step.operation) {
      case Operation::number:
        *++top = step.number;
        break;
      case Operation::symbol:
        *++top = step.address.object == kIndex ? Real(frame.offset(step.address))
                                               : frame.at(step.address);
        break;
      case Operation::negate:
        *top = -*top;
        break;
      case Operation::add:
        --top;
        *top = top[0] + top[1];
        break;
      case Operation::subtract:
        --top;
        *top = top[0] - top[1];
        break;
      case Operation::multiply:
        --top;
        *top = top[0] * top[1];
        break;
      case Operation::divide:
        --top;
        *top = top[0] / top[1];
        break;
      case Operation::call:
        if (step.two_arguments) --top;
        *top = step.function(top[0], step.two_arguments ? top[1] : Real(0));
        break;
    }
  }
  return *top;
}

template NumericFunction<float> numeric_function(const std::string&, FunctionsOf);
template NumericFunction<double> numeric_function(const std::string&, FunctionsOf);
template NumericFunction<long double> numeric_function(const std::string&, FunctionsOf);
template NumericFunction<Quad> numeric_function(const std::string&, FunctionsOf);
template float nearest_number(const Rational&);
template double nearest_number(const Rational&);
template long double nearest_number(const Rational&);
template Quad nearest_number(const Rational&);
template class CompiledExpression<float>;
template class CompiledExpression<double>;
template class CompiledExpression<long double>;
template class CompiledExpression<Quad>;

}  // namespace hamgen
