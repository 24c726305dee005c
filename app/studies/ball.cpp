#include "app/studies/ball.hpp"

#include <flint/fmpq.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/studies/ball_expression.hpp"
#include "generator/algebra/functions.hpp"

namespace hamgen::app {
namespace {

struct BallFunction {
  std::string_view name;
  void (*value)(arb_ptr, arb_srcptr, slong);
};

void absolute_value(arb_ptr result, arb_srcptr x, slong /*bits*/) { arb_abs(result, x); }

// Of the language's functions of one argument.
constexpr std::array<BallFunction, 16> ball_functions = {{{"abs", absolute_value},
                                                          {"acos", arb_acos},
                                                          {"acosh", arb_acosh},
                                                          {"asin", arb_asin},
                                                          {"asinh", arb_asinh},
                                                          {"atan", arb_atan},
                                                          {"atanh", arb_atanh},
                                                          {"cos", arb_cos},
                                                          {"cosh", arb_cosh},
                                                          {"exp", arb_exp},
                                                          {"log", arb_log},
                                                          {"sin", arb_sin},
                                                          {"sinh", arb_sinh},
                                                          {"sqrt", arb_sqrt},
                                                          {"tan", arb_tan},
                                                          {"tanh", arb_tanh}}};

}  // namespace

Ball::Ball(const Rational& value, long bits) : Ball() {
  fmpq_t number;
  fmpq_init(number);
  fmpq_set_mpq(number, value.get_mpq_t());
  arb_set_fmpq(value_, number, bits);
  fmpq_clear(number);
  bits_ = bits;
}

Ball Ball::pi(long bits) {
  Ball result;
  arb_const_pi(result.value_, bits);
  result.bits_ = bits;
  return result;
}

Ball Ball::exact_sum(std::span<const double> parts, long bits) {
  Ball result(0.0, bits);
  for (const double part : parts) {
    const Ball next(part, bits);
    arb_add(result.value_, result.value_, next.value_, ARF_PREC_EXACT);
  }
  return result;
}

Ball Ball::binary(void (*operation)(arb_ptr, arb_srcptr, arb_srcptr, slong), const Ball& x,
                  const Ball& y) {
  Ball result;
  result.bits_ = std::max(x.bits_, y.bits_);
  operation(result.value_, x.value_, y.value_, result.bits_);
  return result;
}

Ball operator-(const Ball& x) {
  Ball result = x;
  arb_neg(result.value_, result.value_);
  return result;
}

void Ball::add_product(const Ball& x, const Ball& y) {
  bits_ = std::max({bits_, x.bits_, y.bits_});
  arb_addmul(value_, x.value_, y.value_, bits_);
}

Ball Ball::power(long exponent) const {
  if (exponent < 0) return Ball(1) / power(-exponent);
  Ball result = *this;
  arb_pow_ui(result.value_, value_, static_cast<ulong>(exponent), bits_);
  return result;
}

Ball Ball::function(std::string_view name, std::span<const Ball> arguments) {
  Ball result;
  if (name == "atan2" && arguments.size() == 2)
    return binary(arb_atan2, arguments[0], arguments[1]);
  const auto* row = std::ranges::find(ball_functions, name, &BallFunction::name);
  if (row == ball_functions.end() || arguments.size() != 1) {
    const Function* others = find_function(name);
    if (others != nullptr && others->by_others != nullptr && arguments.size() == 1) {
      const Expression x = Expression::symbol("x");
      return evaluate_in_balls(others->by_others(std::span(&x, 1)), {{"x", arguments[0]}},
                               arguments[0].bits_);
    }
    arb_indeterminate(result.value_);
    return result;
  }
  result.bits_ = arguments[0].bits_;
  row->value(result.value_, arguments[0].value_, result.bits_);
  return result;
}

bool Ball::is_integer(long& integer) const {
  if (arb_is_int(value_) == 0) return false;
  const double value = arf_get_d(arb_midref(value_), ARF_RND_NEAR);
  if (std::fabs(value) > 1e9) return false;
  integer = std::lround(value);
  return true;
}

Ball Ball::midpoint() const {
  Ball result = *this;
  mag_zero(arb_radref(result.value_));
  return result;
}

Ball Ball::widened(const Ball& by) const {
  Ball result = *this;
  mag_t size;
  mag_init(size);
  arb_get_mag(size, by.value_);
  arb_add_error_mag(result.value_, size);
  mag_clear(size);
  return result;
}

Ball Ball::bound() const {
  Ball result;
  result.bits_ = bits_;
  arb_get_abs_ubound_arf(arb_midref(result.value_), value_, 64);
  return result;
}

double Ball::nearest() const { return arf_get_d(arb_midref(value_), ARF_RND_NEAR); }

double Ball::upper() const {
  if (!is_finite()) return std::numeric_limits<double>::infinity();
  arf_t bound;
  arf_init(bound);
  arb_get_ubound_arf(bound, value_, 64);
  const double result = arf_get_d(bound, ARF_RND_CEIL);
  arf_clear(bound);
  return result;
}

}  // namespace hamgen::app
