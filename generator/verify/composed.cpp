// Splittings and compositions: their order by formal series, and what symmetry says.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "generator/verify/precise.hpp"
#include "generator/verify/proof.hpp"
#include "generator/verify/words.hpp"
#include "generator/verify/zero_by_algebra.hpp"

namespace hamgen {

namespace {

double size_of(const Rational& x) { return std::abs(x.get_d()); }
double size_of(const Precise& x) { return to_double(cln::abs(x)); }
double value_of(const Rational& x) { return x.get_d(); }
double value_of(const Precise& x) { return to_double(x); }
Rational as(const Rational& x, Rational) { return x; }
Precise as(const Rational& x, const Precise&) { return precise(x); }

// Coefficients are given to 40 digits; what they leave of a condition is below this.
constexpr double kDigits = 1e-34;

// What the series of the step differs by from that of the flow.
struct OrderFound {
  int order = 0;
  bool at_least = false;  // nothing was left over as far as was looked
  double residual = 0.0;  // of the conditions that hold
  std::string leading;    // words of the leading error with their coefficients
};

template <class Number>
OrderFound compare(const Series<Number>& step, const Series<Number>& flow,
                   const std::vector<Letter>& letters, int weight, bool nystrom) {
  Series<Number> difference = step;
  for (const auto& [word, value] : flow) {
    const auto [it, fresh] = difference.try_emplace(word, -value);
    if (!fresh) it->second = it->second - value;
  }
  if (nystrom) difference = without_bbba(difference, as(Rational(3), difference.begin()->second));
  OrderFound found;
  for (int w = 1; w <= weight; ++w) {
    double largest = 0;
    for (const auto& [word, value] : difference) {
      if (weight_of(word, letters) == w) largest = std::max(largest, size_of(value));
    }
    if (largest <= kDigits) {
      found.order = w;
      found.residual = std::max(found.residual, largest);
      continue;
    }
    int shown = 0;
    for (const auto& [word, value] : difference) {
      if (weight_of(word, letters) != w || !is_lyndon(word) || size_of(value) <= kDigits) continue;
      if (++shown > 3) break;
      found.leading += fmt::format("{}{:.4g} {}", shown == 1 ? "" : ", ", value_of(value), word);
    }
    return found;
  }
  found.at_least = true;
  return found;
}

Rational factorial(std::size_t n) {
  Rational result = 1;
  for (std::size_t k = 2; k <= n; ++k) result *= static_cast<unsigned long>(k);
  return result;
}

template <class Number>
Series<Number> exponential(char letter, const Number& a, int weight) {
  Series<Number> series;
  Number power = as(Rational(1), a);
  for (int k = 0; k <= weight; ++k) {
    series.emplace(std::string(static_cast<std::size_t>(k), letter),
                   power * as(1 / factorial(static_cast<std::size_t>(k)), a));
    power = power * a;
  }
  return series;
}

// Kicks are B, drifts A; the flow is exp(A + B).  In the formal series the first substep stands
// first.
template <class Number>
OrderFound order_of_splitting(const std::vector<std::pair<char, Number>>& factors, int weight,
                              bool nystrom) {
  const std::vector<Letter> letters{{'A', 1}, {'B', 1}};
  const auto words = words_up_to(letters, weight);
  Series<Number> step{{"", as(Rational(1), factors.front().second)}};
  Series<Number> flow;
  for (const auto& [letter, a] : factors)
    step = product(step, exponential(letter, a, weight), words);
  for (const std::string& word : words) {
    flow.emplace(word, as(1 / factorial(word.size()), factors.front().second));
  }
  return compare(step, flow, letters, weight, nystrom);
}

// A symmetric base is exp(h Y1 + h^3 Y3 + ...), written 1, 3, 5, ..., with the flow exp(h Y1).
template <class Number>
OrderFound order_of_composition(const std::vector<Number>& substeps, int weight, bool symmetric) {
  std::vector<Letter> letters;
  for (int w = 1; w <= weight; w += symmetric ? 2 : 1) {
    letters.push_back({static_cast<char>(w < 10 ? '0' + w : 'a' + w - 10), w});
  }
  const auto words = words_up_to(letters, weight);
  Series<Number> step{{"", as(Rational(1), substeps.front())}};
  for (const Number& c : substeps) {
    Series<Number> substep;
    for (const std::string& word : words) {
      Number value = as(1 / factorial(word.size()), c);
      for (int k = 0; k < weight_of(word, letters); ++k) value = value * c;
      substep.emplace(word, value);
    }
    step = product(step, substep, words);
  }
  return compare(step, exponential('1', as(Rational(1), substeps.front()), weight), letters, weight,
                 false);
}

// Can the conditions hold exactly?  Decimals, whose products have thousands of digits, only hold
// them to their own.
bool are_exact(const std::vector<Expression>& values) {
  const Rational largest(1'000'000'000'000);
  return std::ranges::all_of(values, [&](const Expression& e) {
    return e.is_number() && Rational(e.number().get_den()) <= largest;
  });
}

Finding order_finding(const OrderFound& found, bool exact, const std::string& what) {
  const bool proved = exact && found.residual == 0;
  const std::string how =
      proved ? "exact rational coefficients"
             : fmt::format("conditions hold to {:.0e}, the digits of the coefficients",
                           std::max(found.residual, 1e-60));
  return {fmt::format("order {}", found.order), proved ? Verdict::proved : Verdict::tested,
          fmt::format("formal series against the flow, {}; {}", how,
                      found.at_least ? "no error found in the next power"
                                     : fmt::format("leading error `h^{}` ({}), {}", found.order + 1,
                                                   found.leading, what))};
}

bool is_palindrome(const std::vector<Expression>& values) {
  for (std::size_t i = 0; i < values.size() / 2; ++i) {
    if (!is_zero_by_algebra(values[i] - values[values.size() - 1 - i])) return false;
  }
  return true;
}

std::vector<std::pair<char, Expression>> factors_of(const Splitting& splitting) {
  std::vector<std::pair<char, Expression>> factors;
  std::size_t kick = 0;
  std::size_t drift = 0;
  bool kicks = splitting.kick_first;
  while (kick < splitting.kicks.size() || drift < splitting.drifts.size()) {
    if (kicks && kick < splitting.kicks.size()) factors.emplace_back('B', splitting.kicks[kick++]);
    if (!kicks && drift < splitting.drifts.size())
      factors.emplace_back('A', splitting.drifts[drift++]);
    kicks = !kicks;
  }
  return factors;
}

}  // namespace

Proof prove_splitting(const Splitting& splitting, int order, bool nystrom) {
  const auto factors = factors_of(splitting);
  const bool exact = are_exact(splitting.kicks) && are_exact(splitting.drifts);
  OrderFound found;
  if (exact) {
    std::vector<std::pair<char, Rational>> numbers;
    for (const auto& [letter, a] : factors) numbers.emplace_back(letter, a.number());
    found = order_of_splitting(numbers, order + 1, nystrom);
  } else {
    std::vector<std::pair<char, Precise>> numbers;
    for (const auto& [letter, a] : factors) numbers.emplace_back(letter, value_of_exact(a));
    found = order_of_splitting(numbers, order + 1, nystrom);
  }
  // The adjoint takes the factors in reverse.
  std::vector<Expression> sequence;
  for (const auto& [letter, a] : factors) sequence.push_back(a);
  const bool symmetric = factors.size() % 2 == 1 && is_palindrome(sequence);
  return {prove_shears(splitting),
          {"symmetric", symmetric ? Verdict::proved : Verdict::refuted,
           symmetric ? "the factors are the same from both ends"
                     : "the factors from the other end, its adjoint, are others"},
          order_finding(found, exact,
                        nystrom ? "A drift, B kick, [B,[B,[B,A]]] = 0" : "A drift, B kick")};
}

Proof prove_composition(const Composition& composition, int degrees_of_freedom, int order,
                        const Surroundings& around) {
  const Finding base = prove_step_symplectic(composition.base, degrees_of_freedom, around);
  Finding symplectic = base;
  if (holds(base.verdict)) {
    symplectic.detail =
        fmt::format("each of the {} factors is: {}", composition.substeps.size(), base.detail);
  }
  const Finding base_symmetric = prove_symmetric(composition.base, around);
  const bool odd = holds(base_symmetric.verdict);
  const bool palindrome = is_palindrome(composition.substeps);
  const Verdict symmetric =
      both(palindrome ? Verdict::proved : Verdict::refuted, base_symmetric.verdict);
  const bool exact = are_exact(composition.substeps);
  OrderFound found;
  if (exact) {
    std::vector<Rational> numbers;
    for (const Expression& c : composition.substeps) numbers.push_back(c.number());
    found = order_of_composition(numbers, order + 1, odd);
  } else {
    std::vector<Precise> numbers;
    for (const Expression& c : composition.substeps) numbers.push_back(value_of_exact(c));
    found = order_of_composition(numbers, order + 1, odd);
  }
  const std::string both_ends =
      palindrome
          ? "the substeps are the same from both ends, and the base: " + base_symmetric.detail
          : "the substeps from the other end, its adjoint's, are others";
  const Verdict of_base = odd ? base_symmetric.verdict : Verdict::proved;
  return {symplectic,
          {"symmetric", symmetric, both_ends},
          resting_on(of_base, "the symmetry of the base is tested only",
                     order_finding(found, exact,
                                   "`k` for the `h^k` term of the base's own vector field"))};
}

// A kick has the Jacobian [[1, 0], [-b h V'', 1]], a drift [[1, a h T''], [0, 1]].  With generic
// symmetric V'' and T'' of two degrees of freedom each factor F satisfies F^T J F - J = 0 entry by
// entry; for one degree of freedom the product of them all is multiplied out as well.
Finding prove_shears(const Splitting& splitting) {
  const auto factors = factors_of(splitting);
  const Expression h = Expression::symbol("h");
  auto s = [](std::size_t i, std::size_t j) {
    return Expression::symbol(fmt::format("S{}{}", std::min(i, j) + 1, std::max(i, j) + 1));
  };
  using Rows = std::vector<std::vector<Expression>>;
  auto jacobian = [&](char letter, const Expression& a, std::size_t n, auto entry) {
    Rows f(2 * n, std::vector<Expression>(2 * n, Expression(0)));
    for (std::size_t i = 0; i < 2 * n; ++i) f[i][i] = Expression(1);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        (letter == 'A' ? f[i][n + j] : f[n + i][j]) = (letter == 'A' ? a : -a) * h * entry(i, j);
      }
    }
    return f;
  };
  // (F^T J F)_ij - J_ij
  auto defect = [](const Rows& f, std::size_t i, std::size_t j) {
    const std::size_t n = f.size() / 2;
    Expression sum(j == i + n ? -1 : (i == j + n ? 1 : 0));
    for (std::size_t k = 0; k < n; ++k) sum += f[k][i] * f[n + k][j] - f[n + k][i] * f[k][j];
    return sum;
  };
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const Rows f = jacobian(factors[k].first, factors[k].second, 2, s);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        if (is_zero_by_algebra(defect(f, i, j))) continue;
        return {"symplectic", Verdict::refuted,
                fmt::format("factor {}: entry ({}, {}) of `F^T J F - J` is `{}`", k + 1, i + 1,
                            j + 1, to_text(defect(f, i, j)))};
      }
    }
  }
  std::string detail = fmt::format(
      "`F^T J F - J = 0` for each of the {} shears `F`, entry by entry, with "
      "generic symmetric `V''` and `T''`",
      factors.size());
  if (factors.size() <= 3) {
    Rows m{{Expression(1), Expression(0)}, {Expression(0), Expression(1)}};
    for (std::size_t k = 0; k < factors.size(); ++k) {
      auto own = [&](std::size_t, std::size_t) {
        return Expression::symbol(fmt::format("S{}", k));
      };
      const Rows f = jacobian(factors[k].first, factors[k].second, 1, own);
      m = {{f[0][0] * m[0][0] + f[0][1] * m[1][0], f[0][0] * m[0][1] + f[0][1] * m[1][1]},
           {f[1][0] * m[0][0] + f[1][1] * m[1][0], f[1][0] * m[0][1] + f[1][1] * m[1][1]}};
    }
    if (!is_zero_by_algebra(defect(m, 0, 1))) {
      return {"symplectic", Verdict::refuted, "the product of the factors is not"};
    }
    detail += "; their product `M` multiplied out for `n = 1`: `M^T J M - J = 0`";
  }
  return {"symplectic", Verdict::proved, detail};
}

}  // namespace hamgen
