#include "generator/verify/numerator.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace hamgen {

namespace {

using DenominatorPowers = std::map<GiNaC::ex, int, GiNaC::ex_is_less>;

struct LessPowers {
  bool operator()(const DenominatorPowers& a, const DenominatorPowers& b) const {
    const GiNaC::ex_is_less less;
    return std::ranges::lexicographical_compare(a, b, [&](const auto& x, const auto& y) {
      return less(x.first, y.first) || (!less(y.first, x.first) && x.second < y.second);
    });
  }
};

struct Fraction {
  GiNaC::ex numerator = 1;
  DenominatorPowers denominator;  // of symbols, atoms, and sums whose first coefficient is 1
};

constexpr int kLargestPower = 100;  // of a sum
constexpr long long kLargestExponent = 1'000'000;

void add_power(DenominatorPowers& powers, const GiNaC::ex& base, long long exponent) {
  if (exponent + powers[base] > kLargestExponent) throw std::length_error("a power too large");
  powers[base] += static_cast<int>(exponent);
}

// base^-2, base^(-1/3), base^(-2 a).
bool is_inverse(const GiNaC::ex& e) {
  if (!GiNaC::is_a<GiNaC::power>(e)) return false;
  const GiNaC::ex exponent = e.op(1);
  if (!GiNaC::is_a<GiNaC::mul>(exponent)) return exponent.info(GiNaC::info_flags::negative);
  return std::any_of(exponent.begin(), exponent.end(), [](const GiNaC::ex& factor) {
    return factor.info(GiNaC::info_flags::negative) && GiNaC::is_a<GiNaC::numeric>(factor);
  });
}

bool has_inverses(const GiNaC::ex& sum) {
  const auto of_term = [](const GiNaC::ex& term) {
    return is_inverse(term) ||
           (GiNaC::is_a<GiNaC::mul>(term) && std::any_of(term.begin(), term.end(), is_inverse));
  };
  return GiNaC::is_a<GiNaC::add>(sum) ? std::any_of(sum.begin(), sum.end(), of_term) : of_term(sum);
}

std::size_t terms_of(const GiNaC::ex& sum) { return GiNaC::is_a<GiNaC::add>(sum) ? sum.nops() : 1; }

class Fractions {
 public:
  explicit Fractions(std::size_t most_terms) : most_terms_(most_terms) {}

  // What stands in an expression many times is looked at once.
  Fraction fraction(const GiNaC::ex& e) {
    if (e.nops() == 0) return {.numerator = e};
    if (const auto it = known_.find(e); it != known_.end()) return it->second;
    return known_.emplace(e, of_operands(e)).first->second;
  }

 private:
  Fraction of_operands(const GiNaC::ex& e) {
    if (GiNaC::is_a<GiNaC::add>(e)) return sum(e);
    if (GiNaC::is_a<GiNaC::mul>(e)) {
      Fraction result;
      for (const GiNaC::ex& factor : e) {
        const Fraction f = fraction(factor);
        result.numerator = product(result.numerator, f.numerator);
        for (const auto& [base, exponent] : f.denominator)
          add_power(result.denominator, base, exponent);
      }
      return result;
    }
    if (GiNaC::is_a<GiNaC::power>(e) && e.op(1).info(GiNaC::info_flags::integer)) {
      const GiNaC::numeric exponent = GiNaC::ex_to<GiNaC::numeric>(e.op(1));
      if (abs(exponent) > kLargestExponent) throw std::length_error("a power too large");
      return power(e.op(0), exponent.to_int());
    }
    if (is_inverse(e)) {
      Fraction result;  // of a root
      divide(result, GiNaC::pow(e.op(0), -e.op(1)).map(normal), 1);
      return result;
    }
    return {.numerator = e.map(normal)};
  }

  static GiNaC::ex normal(const GiNaC::ex& e) { return e.normal(); }

  GiNaC::ex product(const GiNaC::ex& a, const GiNaC::ex& b) {
    terms_ += terms_of(a) * terms_of(b);
    if (terms_ > most_terms_) throw std::length_error("products of many terms");
    return (a * b).expand();
  }

  // a base^exponent
  GiNaC::ex times_power(GiNaC::ex a, const GiNaC::ex& base, long long exponent) {
    if (exponent == 0) return a;
    if (exponent > (terms_of(base) == 1 ? kLargestExponent : kLargestPower))
      throw std::length_error("a power too large");
    if (terms_of(base) == 1)
      return product(a, GiNaC::pow(base, GiNaC::numeric(static_cast<long>(exponent))));
    for (int k = 0; k < exponent; ++k) a = product(a, base);
    return a;
  }

  // 1 / polynomial: a product gives its factors, a sum is divided by its first coefficient, so that
  // x - y and 2 y - 2 x are one denominator.
  void divide(Fraction& f, const GiNaC::ex& polynomial, long long times) {
    if (polynomial.is_zero()) throw std::overflow_error("a denominator is identically zero");
    if (GiNaC::is_a<GiNaC::numeric>(polynomial)) {
      f.numerator *= GiNaC::pow(polynomial, -GiNaC::numeric(static_cast<long>(times)));
    } else if (GiNaC::is_a<GiNaC::mul>(polynomial)) {
      for (const GiNaC::ex& factor : polynomial) divide(f, factor, times);
    } else if (GiNaC::is_a<GiNaC::power>(polynomial) &&
               polynomial.op(1).info(GiNaC::info_flags::posint)) {
      divide(f, polynomial.op(0), times * GiNaC::ex_to<GiNaC::numeric>(polynomial.op(1)).to_int());
    } else if (GiNaC::is_a<GiNaC::add>(polynomial)) {
      const GiNaC::ex term = polynomial.op(0);
      GiNaC::ex first = 1;
      for (std::size_t i = 0; GiNaC::is_a<GiNaC::mul>(term) && i < term.nops(); ++i) {
        if (GiNaC::is_a<GiNaC::numeric>(term.op(i))) first *= term.op(i);
      }
      f.numerator *= GiNaC::pow(first, -GiNaC::numeric(static_cast<long>(times)));
      add_power(f.denominator, (polynomial / first).expand(), times);
    } else {
      add_power(f.denominator, polynomial, times);
    }
  }

  // Terms over the same denominators are added first: what cancels asks for no common one.
  Fraction sum(const GiNaC::ex& e) {
    std::map<DenominatorPowers, GiNaC::ex, LessPowers> numerators;
    for (const GiNaC::ex& term : e) {
      const Fraction f = fraction(term);
      numerators[f.denominator] += f.numerator;
    }
    for (auto it = numerators.begin(); it != numerators.end();) {
      it->second = it->second.expand();
      it = it->second.is_zero() ? numerators.erase(it) : std::next(it);
    }
    Fraction result{.numerator = 0};
    for (const auto& [denominator, numerator] : numerators) {
      for (const auto& [base, exponent] : denominator) {
        int& largest = result.denominator[base];
        largest = std::max(largest, exponent);
      }
    }
    for (const auto& [denominator, numerator] : numerators) {
      DenominatorPowers missing = result.denominator;
      for (const auto& [base, exponent] : denominator) missing[base] -= exponent;
      GiNaC::ex term = numerator;
      for (const auto& [base, exponent] : missing) term = times_power(term, base, exponent);
      result.numerator += term;
    }
    return result;
  }

  Fraction power(const GiNaC::ex& base, int exponent) {
    const Fraction f = fraction(base);
    const int times = std::abs(exponent);
    Fraction result;
    if (exponent > 0) {
      result.numerator = times_power(1, f.numerator, times);
      for (const auto& [b, k] : f.denominator)
        add_power(result.denominator, b, static_cast<long long>(k) * times);
    } else {
      for (const auto& [b, k] : f.denominator)
        result.numerator = times_power(result.numerator, b, static_cast<long long>(k) * times);
      divide(result, f.numerator, times);
    }
    return result;
  }

  std::size_t most_terms_;
  std::size_t terms_ = 0;
  std::map<GiNaC::ex, Fraction, GiNaC::ex_is_less> known_;
};

}  // namespace

// What is made of roots may become fractions when it is multiplied.
GiNaC::ex numerator(const GiNaC::ex& e, std::size_t most_terms) {
  GiNaC::ex result = e;
  for (int pass = 0; pass < 5; ++pass) {
    result = Fractions(most_terms).fraction(result).numerator.expand();
    if (!has_inverses(result)) return result;
  }
  throw std::length_error("fractions within fractions");
}

}  // namespace hamgen
