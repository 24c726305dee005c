#include "generator/verify/numerator.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace hamgen {

namespace {

using DenominatorPowers = std::map<GiNaC::ex, int, GiNaC::ex_is_less>;

struct Fraction {
  GiNaC::ex numerator = 1;
  DenominatorPowers denominator;  // irreducible as far as it is seen: symbols, and sums without a factor
};

GiNaC::ex of_factors(const DenominatorPowers& powers) {
  GiNaC::ex result = 1;
  for (const auto& [base, exponent] : powers) result *= GiNaC::pow(base, exponent);
  return result;
}

Fraction fraction(const GiNaC::ex& e);

// 1 / polynomial: a product gives its factors, a sum is divided by its first coefficient, so that
// x - y and 2 y - 2 x are one denominator.
void divide(Fraction& f, const GiNaC::ex& polynomial, int times) {
  if (polynomial.is_zero()) throw std::overflow_error("a denominator is identically zero");
  if (GiNaC::is_a<GiNaC::numeric>(polynomial)) {
    f.numerator *= GiNaC::pow(polynomial, -times);
  } else if (GiNaC::is_a<GiNaC::mul>(polynomial)) {
    for (const GiNaC::ex& factor : polynomial) divide(f, factor, times);
  } else if (GiNaC::is_a<GiNaC::power>(polynomial) &&
             polynomial.op(1).info(GiNaC::info_flags::posint)) {
    divide(f, polynomial.op(0), times * GiNaC::ex_to<GiNaC::numeric>(polynomial.op(1)).to_int());
  } else if (GiNaC::is_a<GiNaC::add>(polynomial)) {
    GiNaC::ex first = 1;
    for (const GiNaC::ex& factor : GiNaC::is_a<GiNaC::mul>(polynomial.op(0))
                                       ? polynomial.op(0)
                                       : GiNaC::ex(GiNaC::lst{polynomial.op(0)})) {
      if (GiNaC::is_a<GiNaC::numeric>(factor)) first *= factor;
    }
    f.numerator *= GiNaC::pow(first, -times);
    f.denominator[(polynomial / first).expand()] += times;
  } else {
    f.denominator[polynomial] += times;
  }
}

Fraction sum(const GiNaC::ex& e) {
  std::vector<Fraction> terms;
  Fraction result{.numerator = 0};
  for (const GiNaC::ex& term : e) {
    for (const auto& [base, exponent] : terms.emplace_back(fraction(term)).denominator) {
      int& largest = result.denominator[base];
      largest = std::max(largest, exponent);
    }
  }
  for (const Fraction& term : terms) {
    DenominatorPowers missing = result.denominator;
    for (const auto& [base, exponent] : term.denominator) missing[base] -= exponent;
    result.numerator += (term.numerator * of_factors(missing)).expand();
  }
  return result;
}

Fraction power(const GiNaC::ex& base, int exponent) {
  const Fraction f = fraction(base);
  const int times = std::abs(exponent);
  Fraction result;
  if (exponent > 0) {
    result.numerator = GiNaC::pow(f.numerator, times).expand();
    for (const auto& [b, k] : f.denominator) result.denominator[b] = k * times;
  } else {
    result.numerator = GiNaC::pow(of_factors(f.denominator), times).expand();
    divide(result, f.numerator, times);
  }
  return result;
}

Fraction fraction(const GiNaC::ex& e) {
  if (GiNaC::is_a<GiNaC::add>(e)) return sum(e);
  if (GiNaC::is_a<GiNaC::mul>(e)) {
    Fraction result;
    for (const GiNaC::ex& factor : e) {
      const Fraction f = fraction(factor);
      result.numerator *= f.numerator;
      for (const auto& [base, exponent] : f.denominator) result.denominator[base] += exponent;
    }
    result.numerator = result.numerator.expand();
    return result;
  }
  if (GiNaC::is_a<GiNaC::power>(e) && e.op(1).info(GiNaC::info_flags::integer)) {
    return power(e.op(0), GiNaC::ex_to<GiNaC::numeric>(e.op(1)).to_int());
  }
  if (e.nops() == 0) return {.numerator = e};
  return {.numerator = e.map([](const GiNaC::ex& x) { return x.normal(); })};
}

}  // namespace

GiNaC::ex numerator(const GiNaC::ex& e) { return fraction(e).numerator.expand(); }

}  // namespace hamgen
