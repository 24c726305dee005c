#include "generator/mechanics/taylor.hpp"

#include "generator/algebra/derivative.hpp"

namespace hamgen {

Expression TaylorSeries::coefficient(const Expression& e, int k) {
  if (k == 0) return e;
  if (e.is_number()) return {};
  const std::pair key(e.identity(), k);
  if (const auto it = known_.find(key); it != known_.end()) return it->second;
  Expression result = compute(e, k);
  keep_alive_.push_back(e);
  known_.emplace(key, result);
  return result;
}

Expression TaylorSeries::compute(const Expression& e, int k) {
  switch (e.kind()) {
    case Kind::number:
      return {};
    case Kind::symbol:
      return input_(e, k);
    case Kind::sum: {
      std::vector<Expression> terms;
      for (const Expression& term : e.operands()) terms.push_back(coefficient(term, k));
      return Expression::sum(std::move(terms));
    }
    case Kind::product: {
      const auto [first, rest] = std::pair(
          e.operands()[0], Expression::product({e.operands().begin() + 1, e.operands().end()}));
      return product(first, rest, k);
    }
    case Kind::power:
      return power(e, k);
    case Kind::function: {
      // From d f(x) = f'(x) dx:  k y_k = sum over j = 1..k of j x_j [f'(x)]_(k-j), for each
      // argument.
      std::vector<Expression> terms;
      for (std::size_t i = 0; i < e.operands().size(); ++i) {
        std::vector<Expression> inner;
        for (int j = 1; j <= k; ++j) inner.push_back(coefficient(e.operands()[i], j));
        Expression slope;
        for (int j = 1; j <= k; ++j) {
          const Expression& x = inner[static_cast<std::size_t>(j) - 1];
          if (x.is_zero()) continue;
          if (slope.is_zero()) slope = partial_derivative(e, i);
          terms.push_back(Expression(Rational(j, k)) * x * coefficient(slope, k - j));
        }
      }
      return Expression::sum(std::move(terms));
    }
  }
  return {};
}

Expression TaylorSeries::product(const Expression& a, const Expression& b, int k) {
  std::vector<Expression> terms;
  for (int j = 0; j <= k; ++j) {
    const Expression left = coefficient(a, j);
    if (!left.is_zero()) terms.push_back(left * coefficient(b, k - j));
  }
  return Expression::sum(std::move(terms));
}

Expression TaylorSeries::power(const Expression& e, int k) {
  const Expression& x = e.operands()[0];
  const Expression& exponent = e.operands()[1];
  if (!exponent.is_number()) {
    return coefficient(Expression::apply("exp", {exponent * Expression::apply("log", {x})}), k);
  }
  const Rational& n = exponent.number();
  if (n > 0 && n.get_den() == 1) {
    // By products, which hold at x = 0 too.
    return product(x, Expression::power(x, Expression(Rational(n - 1))), k);
  }
  // From x dy = n y dx:  k x y_k = sum over j = 1..k of (j n - (k - j)) x_j y_(k-j).
  std::vector<Expression> terms;
  for (int j = 1; j <= k; ++j) {
    const Expression inner = coefficient(x, j);
    const Rational weight = Rational(j) * n - Rational(k - j);
    if (inner.is_zero() || weight == 0) continue;
    terms.push_back(Expression(Rational(weight / k)) * inner * coefficient(e, k - j));
  }
  return Expression::sum(std::move(terms)) * Expression::power(x, Expression(-1));
}

}  // namespace hamgen
