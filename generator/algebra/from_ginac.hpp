// The border with GiNaC: it derives, it never prints.  Its address-dependent order of terms ends
// here; everything behind holds Expression.
#pragma once

#include <cln/integer.h>
#include <cln/rational.h>
#include <ginac/ginac.h>

#include <map>
#include <string>

#include "generator/algebra/expression.hpp"
#include "generator/algebra/ginac_parts.hpp"

namespace hamgen {

// GiNaC symbols of one derivation, by name, and the ranks they get on the way back.
class SymbolTable {
 public:
  // The real symbol of that name; made at its first use with the given rank.
  GiNaC::ex symbol(const std::string& name, int rank);
  [[nodiscard]] int rank(const std::string& name) const;
  [[nodiscard]] const GiNaC::symbol& find(const std::string& name) const;

 private:
  std::map<std::string, std::pair<GiNaC::realsymbol, int>> symbols_;
};

// Converts expressions that share parts, each part once.
class FromGinac {
 public:
  explicit FromGinac(const SymbolTable& table) : table_(table) {}
  // Throws std::domain_error if the expression holds something that is not real or not a scalar.
  [[nodiscard]] Expression operator()(const GiNaC::ex& e);

 private:
  [[nodiscard]] static Expression number(const GiNaC::ex& value);
  [[nodiscard]] Expression function(const GiNaC::ex& node);

  const SymbolTable& table_;
  ByIdentity<Expression> done_;
};

[[nodiscard]] Expression from_ginac(const GiNaC::ex& e, const SymbolTable& table);
[[nodiscard]] GiNaC::ex to_ginac(const Expression& e, SymbolTable& table);
// At most so many terms, those of roots and denominators among them, are written when it is
// expanded.
[[nodiscard]] double expanded_terms(const GiNaC::ex& e);
// Is it identically 0, as far as expanding shows?  False of all that is not written as 0 and would
// expand to more than a moderate number of terms.
[[nodiscard]] bool vanishes(const Expression& e);
[[nodiscard]] bool vanishes_when_expanded(const GiNaC::ex& e);
// By its binary digits: a proof at points converts as many numbers as it meets.
[[nodiscard]] cln::cl_I to_cln(const Integer& value);
[[nodiscard]] cln::cl_RA to_cln(const Rational& value);
[[nodiscard]] GiNaC::numeric to_ginac(const Rational& value);
[[nodiscard]] Rational to_rational(const GiNaC::numeric& value);

}  // namespace hamgen
