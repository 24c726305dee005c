// Expressions as polynomials: sums of products of atoms with rational coefficients.
//
// An atom is what multiplication cannot take apart: a symbol, a function's value such as cos(q), or
// a root or reciprocal of a sum.  Its exponent may be negative.  sin(x)^2 is written 1 - cos(x)^2
// and sinh(x)^2 as cosh(x)^2 - 1, so that a polynomial in these atoms has one form.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>
#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen {

using Monomial = std::vector<std::int16_t>;  // exponents by atom, without zeros at the end
using Polynomial = std::map<Monomial, Rational>;

struct TooManyTerms : std::runtime_error {
  TooManyTerms() : std::runtime_error("the polynomial has too many terms") {}
};

class PolynomialRing {
 public:
  // Throws TooManyTerms from any function whose result would have more terms.
  explicit PolynomialRing(std::size_t most_terms) : most_terms_(most_terms) {}

  [[nodiscard]] Polynomial expand(const Expression& e);
  [[nodiscard]] Polynomial product(const Polynomial& a, const Polynomial& b);
  [[nodiscard]] Polynomial derivative(const Polynomial& p, const Expression& symbol);
  // The derivative by an atom, as if atoms were independent of each other.
  [[nodiscard]] Polynomial atom_derivative(const Polynomial& p, std::size_t atom) const;

  [[nodiscard]] std::size_t size() const { return atoms_.size(); }
  [[nodiscard]] const Expression& atom(std::size_t i) const { return atoms_[i]; }

  // Nested by Horner's rule over the atoms that `varies` names; the others gather in coefficients.
  using Predicate = std::function<bool(const Expression& atom)>;
  [[nodiscard]] Expression horner(const Polynomial& p, const Predicate& varies) const;

 private:
  struct Term {
    Monomial exponents;
    Expression coefficient;
  };
  [[nodiscard]] std::size_t find_atom(const Expression& value);
  [[nodiscard]] Polynomial power(const Expression& base, const Rational& exponent);
  void add(Polynomial& p, Monomial monomial, Rational coefficient) const;
  [[nodiscard]] Expression nest(std::vector<Term> terms) const;

  std::size_t most_terms_;
  std::vector<Expression> atoms_;
  ExpressionMap<std::size_t> places_;
  ExpressionMap<long> roots_;  // base: the d of its atom base^(1/d)
  std::map<std::size_t, std::pair<std::size_t, int>> squares_;  // sin: {cos, 1}: s^2 = 1 - c^2
  ExpressionMap<Polynomial> expanded_;
  std::map<std::pair<std::size_t, std::string>, Polynomial> slopes_;
};

void accumulate(Polynomial& sum, const Polynomial& p, const Rational& factor = 1);

}  // namespace hamgen
