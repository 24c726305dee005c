#include "generator/verify/real_roots.hpp"

#include <algorithm>
#include <cstdint>

namespace hamgen {

RationalPolynomial trimmed(RationalPolynomial p) {
  while (!p.empty() && p.back() == 0) p.pop_back();
  return p;
}

int degree(const RationalPolynomial& p) { return static_cast<int>(p.size()) - 1; }

Rational value_at(const RationalPolynomial& p, const Rational& x) {
  Rational value = 0;
  for (std::size_t k = p.size(); k-- > 0;) value = value * x + p[k];
  return value;
}

RationalPolynomial sum_of(const RationalPolynomial& p, const RationalPolynomial& q) {
  RationalPolynomial result(std::max(p.size(), q.size()));
  for (std::size_t k = 0; k < p.size(); ++k) result[k] += p[k];
  for (std::size_t k = 0; k < q.size(); ++k) result[k] += q[k];
  return trimmed(std::move(result));
}

RationalPolynomial scaled_by(const Rational& c, RationalPolynomial p) {
  for (Rational& x : p) x *= c;
  return trimmed(std::move(p));
}

RationalPolynomial product_of(const RationalPolynomial& p, const RationalPolynomial& q) {
  if (p.empty() || q.empty()) return {};
  RationalPolynomial result(p.size() + q.size() - 1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) result[i + j] += p[i] * q[j];
  }
  return result;
}

std::pair<RationalPolynomial, RationalPolynomial> divided(RationalPolynomial p,
                                                          const RationalPolynomial& q) {
  RationalPolynomial quotient;
  while (p.size() >= q.size()) {
    const std::size_t shift = p.size() - q.size();
    const Rational factor = p.back() / q.back();
    quotient.resize(std::max(quotient.size(), shift + 1));
    quotient[shift] = factor;
    for (std::size_t k = 0; k < q.size(); ++k) p[shift + k] -= factor * q[k];
    p.pop_back();
    p = trimmed(std::move(p));
  }
  return {std::move(quotient), std::move(p)};
}

RationalPolynomial primitive(RationalPolynomial p) {
  if (p.empty()) return p;
  Integer over = 0;
  Integer under = 1;
  for (const Rational& x : p) {
    mpz_gcd(over.get_mpz_t(), over.get_mpz_t(), x.get_num_mpz_t());
    mpz_lcm(under.get_mpz_t(), under.get_mpz_t(), x.get_den_mpz_t());
  }
  Rational factor(under, over);
  factor.canonicalize();
  return scaled_by(factor, std::move(p));
}

RationalPolynomial common_divisor(RationalPolynomial p, RationalPolynomial q) {
  while (!q.empty()) {
    RationalPolynomial rest = primitive(divided(std::move(p), q).second);
    p = std::move(q);
    q = std::move(rest);
  }
  return primitive(std::move(p));
}

namespace {

RationalPolynomial slope_of(const RationalPolynomial& p) {
  RationalPolynomial result;
  for (std::size_t k = 1; k < p.size(); ++k) result.push_back(p[k] * static_cast<unsigned long>(k));
  return result;
}

int sign_at(const RationalPolynomial& p, const Rational& x) { return sgn(value_at(p, x)); }

// Above the size of every root (Cauchy).
Rational root_bound(const RationalPolynomial& p) {
  Rational largest = 0;
  for (const Rational& x : p) largest = std::max(largest, Rational(abs(x / p.back())));
  return largest + 1;
}

}  // namespace

// Yun: with g = gcd(p, p') the roots of p/g are those of p, each once.
std::vector<std::pair<RationalPolynomial, int>> square_free_factors(const RationalPolynomial& p) {
  std::vector<std::pair<RationalPolynomial, int>> factors;
  if (degree(p) < 1) return factors;
  RationalPolynomial rest = common_divisor(p, slope_of(p));
  RationalPolynomial once = divided(p, rest).first;
  for (int multiplicity = 1; degree(once) > 0; ++multiplicity) {
    RationalPolynomial again = common_divisor(once, rest);
    const RationalPolynomial factor = divided(once, again).first;
    const Rational sign = factor.back() < 0 ? -1 : 1;
    if (degree(factor) > 0) factors.emplace_back(primitive(scaled_by(sign, factor)), multiplicity);
    rest = divided(rest, again).first;
    once = std::move(again);
  }
  return factors;
}

RationalPolynomial square_free_part(const RationalPolynomial& p) {
  if (degree(p) < 1) return p;
  return primitive(divided(p, common_divisor(p, slope_of(p))).first);
}

// Newton's divided differences.
RationalPolynomial interpolated(const std::vector<std::pair<Rational, Rational>>& points) {
  std::vector<Rational> differences;
  for (const auto& [x, value] : points) differences.push_back(value);
  for (std::size_t order = 1; order < points.size(); ++order) {
    for (std::size_t k = points.size(); k-- > order;) {
      differences[k] =
          (differences[k] - differences[k - 1]) / (points[k].first - points[k - order].first);
    }
  }
  RationalPolynomial result;
  for (std::size_t k = points.size(); k-- > 0;) {
    result = product_of(result, {-points[k].first, Rational(1)});
    result = sum_of(result, {differences[k]});
  }
  return trimmed(std::move(result));
}

namespace {

std::vector<RationalPolynomial> sturm_sequence(const RationalPolynomial& square_free) {
  std::vector<RationalPolynomial> chain{primitive(square_free)};
  if (degree(square_free) < 1) return chain;
  chain.push_back(primitive(slope_of(square_free)));
  while (degree(chain.back()) > 0) {
    RationalPolynomial rest = divided(chain[chain.size() - 2], chain.back()).second;
    if (rest.empty()) break;
    chain.push_back(scaled_by(Rational(-1), primitive(std::move(rest))));
  }
  return chain;
}

int changes_of_sign(const std::vector<int>& signs) {
  int changes = 0;
  int last = 0;
  for (const int sign : signs) {
    if (sign == 0) continue;
    if (last != 0 && sign != last) ++changes;
    last = sign;
  }
  return changes;
}

int changes_at(const std::vector<RationalPolynomial>& chain, const std::optional<Rational>& x,
               bool at_plus_infinity) {
  std::vector<int> signs;
  for (const RationalPolynomial& p : chain) {
    if (x) {
      signs.push_back(sign_at(p, *x));
    } else {
      signs.push_back(sgn(p.back()) * (!at_plus_infinity && degree(p) % 2 != 0 ? -1 : 1));
    }
  }
  return changes_of_sign(signs);
}

using IntegerPolynomial = std::vector<Integer>;

IntegerPolynomial integers(const RationalPolynomial& p) {
  IntegerPolynomial result;
  for (const Rational& x : primitive(p)) result.push_back(x.get_num());
  return result;
}

// The sign of p(a/b), b > 0, of b^n p.
int sign_at(const IntegerPolynomial& p, const Rational& x) {
  Integer power = 1;
  Integer sum = 0;
  for (std::size_t k = p.size(); k-- > 0;) {
    sum = sum * x.get_num() + p[k] * power;
    power *= x.get_den();
  }
  return sgn(sum);
}

// p(x + 1).
void shift(IntegerPolynomial& p) {
  for (std::size_t first = 0; first + 1 < p.size(); ++first) {
    for (std::size_t k = p.size() - 1; k-- > first;) p[k] += p[k + 1];
  }
}

// An upper bound of the number of roots with 0 < x < 1, of the same parity; 0 and 1 are exact.
int descartes_bound(IntegerPolynomial p) {
  std::ranges::reverse(p);
  shift(p);
  std::vector<int> signs;
  for (const Integer& x : p) signs.push_back(sgn(x));
  return changes_of_sign(signs);
}

struct Isolation {
  std::vector<std::pair<Rational, Rational>> found;

  // The roots of p with 0 < x < 1, which are low + width x.  The first is not taken for alone until
  // it is away from 0.
  void look(IntegerPolynomial p, const Rational& low, const Rational& width) {
    while (!p.empty() && p.front() == 0) p.erase(p.begin());  // at low, which was noted before
    const int bound = descartes_bound(p);
    if (bound == 0) return;
    if (bound == 1 && low > 0) {
      found.emplace_back(low, low + width);
      return;
    }
    // 2^n p(x/2)
    const auto n = p.size() - 1;
    for (std::size_t k = 0; k <= n; ++k) p[k] <<= n - k;
    const Rational half = width / 2;
    look(p, low, half);
    shift(p);
    if (p.front() == 0) found.emplace_back(low + half, low + half);
    look(std::move(p), low + half, half);
  }
};

// Has it no multiple roots modulo a prime?  Then it has none.
bool is_square_free_modulo_prime(const IntegerPolynomial& p) {
  constexpr std::uint64_t prime = 2147483647U;
  using Residues = std::vector<std::uint64_t>;
  const auto trim = [](Residues& r) {
    while (!r.empty() && r.back() == 0) r.pop_back();
  };
  Residues a;
  for (const Integer& x : p) a.push_back(mpz_fdiv_ui(x.get_mpz_t(), prime));
  if (a.back() == 0) return false;
  Residues b;
  for (std::size_t k = 1; k < a.size(); ++k) b.push_back(a[k] * k % prime);
  trim(b);
  const auto inverse = [](std::uint64_t x) {
    std::uint64_t result = 1;
    for (std::uint64_t power = prime - 2; power > 0; power /= 2) {
      if (power % 2 != 0) result = result * x % prime;
      x = x * x % prime;
    }
    return result;
  };
  while (!b.empty()) {
    while (a.size() >= b.size()) {
      const std::uint64_t factor = a.back() * inverse(b.back()) % prime;
      const std::size_t by = a.size() - b.size();
      for (std::size_t k = 0; k < b.size(); ++k)
        a[by + k] = (a[by + k] + (prime - factor) * b[k]) % prime;
      trim(a);
      if (a.empty()) break;
    }
    std::swap(a, b);
  }
  return a.size() == 1;
}

// Of a simple root alone in low < x < high, whose ends may be roots of their own.
void refine(const IntegerPolynomial& p, std::pair<Rational, Rational>& root) {
  auto& [low, high] = root;
  if (low == high) return;
  int sign_before_high = sign_at(p, high);
  if (sign_before_high == 0) {
    IntegerPolynomial slope;
    for (std::size_t k = 1; k < p.size(); ++k)
      slope.push_back(p[k] * static_cast<unsigned long>(k));
    sign_before_high = -sign_at(slope, high);
  }
  while ((high - low) * 100000000000000L > high) {
    const Rational middle = (low + high) / 2;
    const int sign = sign_at(p, middle);
    if (sign == 0) {
      low = high = middle;
      return;
    }
    (sign == sign_before_high ? high : low) = middle;
  }
}

}  // namespace

std::vector<std::pair<Rational, Rational>> positive_roots(const RationalPolynomial& polynomial) {
  RationalPolynomial p = polynomial;
  while (!p.empty() && p.front() == 0) p.erase(p.begin());
  if (degree(p) < 1) return {};
  if (!is_square_free_modulo_prime(integers(p))) p = square_free_part(p);
  Rational bound = 1;
  while (bound < root_bound(p)) bound *= 2;
  RationalPolynomial scaled = p;  // p(bound x)
  Rational power = 1;
  for (Rational& x : scaled) {
    x *= power;
    power *= bound;
  }
  Isolation isolation;
  isolation.look(integers(scaled), Rational(0), Rational(1));
  const IntegerPolynomial whole = integers(p);
  for (auto& root : isolation.found) {
    root.first *= bound;
    root.second *= bound;
    refine(whole, root);
  }
  return isolation.found;
}

// Sturm's theorem counts low < x <= high.
int count_roots(const RationalPolynomial& square_free, const std::optional<Rational>& low,
                const std::optional<Rational>& high) {
  const std::vector<RationalPolynomial> chain = sturm_sequence(square_free);
  const bool ends_at_root = high && sign_at(chain.front(), *high) == 0;
  return changes_at(chain, low, false) - changes_at(chain, high, true) - (ends_at_root ? 1 : 0);
}

Rational simple_between(const Rational& low, const Rational& high) {
  Rational unit = 1;
  while (unit >= high - low) unit /= 2;
  while (2 * unit < high - low) unit *= 2;
  unit /= 2;
  const Rational scaled = (low + high) / 2 / unit;
  Integer whole;
  mpz_fdiv_q(whole.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  return Rational(whole) * unit;
}

}  // namespace hamgen
