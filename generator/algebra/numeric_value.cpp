// Constants such as sqrt(3)/6 or 1/(4 - 4^(1/3)) as numbers.
#include "generator/algebra/expression.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

constexpr unsigned long kBits = 320;  // after the point: 96 digits

Rational rounded(const Rational& value) {
  Integer scaled = value.get_num() << kBits;
  mpz_fdiv_q(scaled.get_mpz_t(), scaled.get_mpz_t(), value.get_den_mpz_t());
  Rational result(scaled, Integer(1) << kBits);
  result.canonicalize();
  return result;
}

// base^(1/degree) for base > 0: the integer root of base 2^(degree bits), divided by 2^bits.
Rational root(const Rational& base, unsigned long degree) {
  Integer scaled = base.get_num() << (degree * kBits);
  mpz_fdiv_q(scaled.get_mpz_t(), scaled.get_mpz_t(), base.get_den_mpz_t());
  mpz_root(scaled.get_mpz_t(), scaled.get_mpz_t(), degree);
  Rational result(scaled, Integer(1) << kBits);
  result.canonicalize();
  return result;
}

}  // namespace

Rational numeric_value(const Expression& e) {
  switch (e.kind()) {
    case Kind::number:
      return e.number();
    case Kind::sum: {
      Rational sum(0);
      for (const Expression& term : e.operands()) sum += numeric_value(term);
      return sum;
    }
    case Kind::product: {
      Rational product(1);
      for (const Expression& factor : e.operands()) product = product * numeric_value(factor);
      return product.get_den() == 1 ? product : rounded(product);
    }
    case Kind::power: {
      if (!e.operands()[1].is_number()) break;
      const Rational exponent = e.operands()[1].number();
      const Rational base = numeric_value(e.operands()[0]);
      if (exponent.get_den() != 1 && base <= 0) break;
      const Rational radical =
          exponent.get_den() == 1 ? base : root(base, exponent.get_den().get_ui());
      const auto value = integer_power(rounded(radical), exponent.get_num().get_si());
      if (!value) break;
      return rounded(*value);
    }
    case Kind::symbol:
    case Kind::function:
      break;
  }
  internal_error("not an algebraic constant: " + to_text(e));
}

}  // namespace hamgen
