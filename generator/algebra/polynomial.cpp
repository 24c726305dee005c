#include "generator/algebra/polynomial.hpp"

#include <algorithm>

#include "generator/algebra/derivative.hpp"
#include "generator/algebra/functions.hpp"

namespace hamgen {

namespace {

std::int16_t exponent_of(const Monomial& m, std::size_t atom) {
  return atom < m.size() ? m[atom] : std::int16_t{0};
}

void set_exponent(Monomial& m, std::size_t atom, int exponent) {
  if (m.size() <= atom) m.resize(atom + 1);
  m[atom] = static_cast<std::int16_t>(exponent);
}

Polynomial single(std::size_t atom, long exponent) {
  Monomial m;
  set_exponent(m, atom, static_cast<int>(exponent));
  return {{m, Rational(1)}};
}

}  // namespace

void accumulate(Polynomial& sum, const Polynomial& p, const Rational& factor) {
  for (const auto& [monomial, coefficient] : p) {
    const auto [it, fresh] = sum.try_emplace(monomial, 0);
    it->second += factor * coefficient;
    if (it->second == 0) sum.erase(it);
  }
}

std::size_t PolynomialRing::find_atom(const Expression& value) {
  if (const auto it = places_.find(value); it != places_.end()) return it->second;
  const std::size_t place = atoms_.size();
  atoms_.push_back(value);
  places_.emplace(value, place);
  if (value.kind() == Kind::function) {
    const Function* row = find_function(value.name());
    if (row != nullptr && !row->square_partner.empty()) {
      const std::string partner(row->square_partner);
      squares_[place] = {find_atom(Expression::apply(partner, {value.operands()[0]})),
                         row->square_sign};
    }
  }
  return place;
}

// Adds coefficient * monomial with the squares of sines replaced.
void PolynomialRing::add(Polynomial& p, Monomial monomial, Rational coefficient) const {
  for (const auto& [sine, partner] : squares_) {
    const int exponent = exponent_of(monomial, sine);
    if (exponent < 2) continue;
    // s^2 = sign (1 - c^2).
    const auto [cosine, sign] = partner;
    set_exponent(monomial, sine, exponent - 2);
    Monomial other = monomial;
    set_exponent(other, cosine, exponent_of(monomial, cosine) + 2);
    add(p, std::move(monomial), Rational(sign * coefficient));
    add(p, std::move(other), Rational(-sign * coefficient));
    return;
  }
  while (!monomial.empty() && monomial.back() == 0) monomial.pop_back();
  const auto [it, fresh] = p.try_emplace(std::move(monomial), 0);
  it->second += coefficient;
  if (it->second == 0) p.erase(it);
  if (p.size() > most_terms_) throw TooManyTerms();
}

Polynomial PolynomialRing::product(const Polynomial& a, const Polynomial& b) {
  if (a.size() * b.size() > 64 * most_terms_) throw TooManyTerms();
  Polynomial result;
  for (const auto& [left, x] : a) {
    for (const auto& [right, y] : b) {
      Monomial m = left;
      if (m.size() < right.size()) m.resize(right.size());
      for (std::size_t i = 0; i < right.size(); ++i) {
        m[i] = static_cast<std::int16_t>(m[i] + right[i]);
      }
      add(result, std::move(m), Rational(x * y));
    }
  }
  return result;
}

// base^exponent: an atom unless the exponent is a positive integer.
Polynomial PolynomialRing::power(const Expression& base, const Rational& exponent) {
  const bool integer = exponent.get_den() == 1;
  const bool atomic = base.kind() == Kind::symbol || base.kind() == Kind::function;
  if (integer && exponent > 0 && !(atomic && roots_.contains(base))) {
    const Polynomial factor = expand(base);
    Polynomial result = factor;
    for (Rational k = 1; k < exponent; k += 1) result = product(result, factor);
    return result;
  }
  const long denominator = exponent.get_den().get_si();
  const auto [it, fresh] = roots_.try_emplace(base, denominator);
  const Rational scaled = exponent * it->second;
  if (scaled.get_den() == 1) {
    const Expression root = Expression::power(base, Expression(Rational(1, it->second)));
    return single(find_atom(root), scaled.get_num().get_si());
  }
  return single(find_atom(Expression::power(base, Expression(exponent))), 1);
}

Polynomial PolynomialRing::expand(const Expression& e) {
  if (e.is_number()) {
    return e.is_zero() ? Polynomial{} : Polynomial{{Monomial{}, e.number()}};
  }
  if (const auto it = expanded_.find(e); it != expanded_.end()) return it->second;
  Polynomial result;
  switch (e.kind()) {
    case Kind::number:
      break;
    case Kind::sum:
      for (const Expression& term : e.operands()) accumulate(result, expand(term));
      break;
    case Kind::product:
      result = expand(e.operands()[0]);
      for (const Expression& factor : e.operands().subspan(1)) {
        result = product(result, expand(factor));
      }
      break;
    case Kind::power:
      if (e.operands()[1].is_number()) {
        result = power(e.operands()[0], e.operands()[1].number());
      } else {
        result = single(find_atom(e), 1);
      }
      break;
    case Kind::symbol:
    case Kind::function: {
      const auto root = roots_.find(e);
      if (root != roots_.end() && root->second != 1) {
        result = power(e, 1);
      } else {
        result = single(find_atom(e), 1);
      }
      break;
    }
  }
  expanded_.emplace(e, result);
  return result;
}

Polynomial PolynomialRing::atom_derivative(const Polynomial& p, std::size_t atom) const {
  Polynomial result;
  for (const auto& [monomial, coefficient] : p) {
    const int exponent = exponent_of(monomial, atom);
    if (exponent == 0) continue;
    Monomial lower = monomial;
    set_exponent(lower, atom, exponent - 1);
    add(result, std::move(lower), Rational(exponent * coefficient));
  }
  return result;
}

Polynomial PolynomialRing::derivative(const Polynomial& p, const Expression& symbol) {
  Polynomial result;
  const std::size_t count = atoms_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Polynomial outer = atom_derivative(p, i);
    if (outer.empty()) continue;
    const std::pair key(i, symbol.name());
    auto it = slopes_.find(key);
    if (it == slopes_.end()) {
      it = slopes_.emplace(key, expand(hamgen::derivative(Expression(atoms_[i]), symbol))).first;
    }
    if (!it->second.empty()) accumulate(result, product(outer, it->second));
  }
  return result;
}

Expression PolynomialRing::horner(const Polynomial& p, const Predicate& varies) const {
  std::vector<bool> moves;
  for (const Expression& atom : atoms_) moves.push_back(varies(atom));
  std::map<Monomial, std::vector<Expression>> gathered;
  for (const auto& [monomial, coefficient] : p) {
    Monomial moving(monomial.size());
    std::vector<Expression> factors{Expression(coefficient)};
    for (std::size_t i = 0; i < monomial.size(); ++i) {
      if (monomial[i] == 0) continue;
      if (moves[i]) {
        moving[i] = monomial[i];
      } else {
        factors.push_back(Expression::power(atoms_[i], Expression(long{monomial[i]})));
      }
    }
    gathered[moving].push_back(Expression::product(std::move(factors)));
  }
  std::vector<Term> terms;
  for (auto& [monomial, parts] : gathered) {
    terms.push_back({monomial, Expression::sum(std::move(parts))});
    terms.back().exponents.resize(atoms_.size());
  }
  return nest(std::move(terms));
}

// The atom (or its reciprocal) that most terms contain is factored out of them, as often as they
// all contain it; then the same for what is inside and for what is left.
Expression PolynomialRing::nest(std::vector<Term> terms) const {
  std::size_t most = 1;
  std::size_t chosen = 0;
  int direction = 0;
  for (std::size_t i = 0; i < atoms_.size(); ++i) {
    for (const int sign : {1, -1}) {
      const auto count = static_cast<std::size_t>(std::ranges::count_if(
          terms, [&](const Term& term) { return sign * term.exponents[i] > 0; }));
      if (count <= most) continue;
      most = count;
      chosen = i;
      direction = sign;
    }
  }
  std::vector<Expression> sum;
  if (direction == 0) {
    for (const Term& term : terms) {
      std::vector<Expression> factors{term.coefficient};
      for (std::size_t i = 0; i < atoms_.size(); ++i) {
        if (term.exponents[i] == 0) continue;
        factors.push_back(Expression::power(atoms_[i], Expression(long{term.exponents[i]})));
      }
      sum.push_back(Expression::product(std::move(factors)));
    }
    return Expression::sum(std::move(sum));
  }
  std::vector<Term> inside;
  std::vector<Term> rest;
  int least = 0;
  for (Term& term : terms) {
    const int size = direction * term.exponents[chosen];
    if (size <= 0) {
      rest.push_back(std::move(term));
      continue;
    }
    least = least == 0 ? size : std::min(least, size);
    inside.push_back(std::move(term));
  }
  for (Term& term : inside) {
    term.exponents[chosen] = static_cast<std::int16_t>(term.exponents[chosen] - direction * least);
  }
  const Expression factor = Expression::power(atoms_[chosen], Expression(long{direction} * least));
  sum.push_back(factor * nest(std::move(inside)));
  if (!rest.empty()) sum.push_back(nest(std::move(rest)));
  return Expression::sum(std::move(sum));
}

}  // namespace hamgen
