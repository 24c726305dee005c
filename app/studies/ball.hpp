// Real numbers enclosed in balls (Arb): what is computed of them encloses what is true of every
// number in them.
#pragma once

#include <arb.h>

#include <span>
#include <string_view>

#include "generator/algebra/exact.hpp"

namespace hamgen::app {

// A midpoint and a radius.  A result is rounded to the bits of the wider operand, and its radius
// says so; what is not defined everywhere in the operands is not finite.
class Ball {
 public:
  Ball() { arb_init(value_); }
  Ball(long integer) : Ball() { arb_set_si(value_, integer); }  // NOLINT: integers are balls
  // An exact double, in computations with so many bits.
  Ball(double exact, long bits) : Ball() {
    arb_set_d(value_, exact);
    bits_ = bits;
  }
  // The rational to so many bits.
  Ball(const Rational& value, long bits);
  Ball(const Ball& other) : Ball() {
    arb_set(value_, other.value_);
    bits_ = other.bits_;
  }
  Ball(Ball&& other) noexcept : Ball() { swap(other); }
  Ball& operator=(Ball other) {
    swap(other);
    return *this;
  }
  ~Ball() { arb_clear(value_); }

  [[nodiscard]] static Ball pi(long bits);
  // Of doubles, whatever their exponents.
  [[nodiscard]] static Ball exact_sum(std::span<const double> parts, long bits);

  friend Ball operator+(const Ball& x, const Ball& y) { return binary(arb_add, x, y); }
  friend Ball operator-(const Ball& x, const Ball& y) { return binary(arb_sub, x, y); }
  friend Ball operator*(const Ball& x, const Ball& y) { return binary(arb_mul, x, y); }
  friend Ball operator/(const Ball& x, const Ball& y) { return binary(arb_div, x, y); }
  friend Ball operator-(const Ball& x);
  Ball& operator+=(const Ball& y) { return *this = *this + y; }
  Ball& operator-=(const Ball& y) { return *this = *this - y; }
  // this += x y
  void add_product(const Ball& x, const Ball& y);

  // x^n; x^y, for y that is no integer of positive x only.
  [[nodiscard]] Ball power(long exponent) const;
  [[nodiscard]] Ball power(const Ball& exponent) const { return binary(arb_pow, *this, exponent); }
  // A function of the language with one argument, or atan2(y, x); not finite for any other name.
  [[nodiscard]] static Ball function(std::string_view name, std::span<const Ball> arguments);

  [[nodiscard]] bool is_finite() const { return arb_is_finite(value_) != 0; }
  [[nodiscard]] bool is_zero() const { return arb_is_zero(value_) != 0; }
  [[nodiscard]] bool contains_zero() const { return arb_contains_zero(value_) != 0; }
  // Exactly an integer that fits.
  [[nodiscard]] bool is_integer(long& integer) const;
  [[nodiscard]] friend bool certainly_less(const Ball& x, const Ball& y) {
    return arb_lt(x.value_, y.value_) != 0;
  }

  [[nodiscard]] Ball midpoint() const;
  // The ball widened by an upper bound of |by|.
  [[nodiscard]] Ball widened(const Ball& by) const;
  // An exact upper bound of the absolute values in it.
  [[nodiscard]] Ball bound() const;
  [[nodiscard]] double nearest() const;  // of the midpoint
  [[nodiscard]] double upper() const;    // no number in the ball is larger

  [[nodiscard]] long bits() const { return bits_; }

 private:
  static Ball binary(void (*operation)(arb_ptr, arb_srcptr, arb_srcptr, slong), const Ball& x,
                     const Ball& y);
  void swap(Ball& other) noexcept {
    arb_swap(value_, other.value_);
    std::swap(bits_, other.bits_);
  }

  arb_t value_;
  long bits_ = 64;
};

}  // namespace hamgen::app
