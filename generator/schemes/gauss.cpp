// Collocation at the zeros of the shifted Legendre polynomial: order 2 s with s stages.
#include <fmt/format.h>

#include "generator/schemes/all_schemes.hpp"

namespace hamgen {

namespace {

using Polynomial = std::vector<Rational>;  // coefficients of 1, x, x^2, ...

// 77 digits: twice those of the widest scalar.
constexpr unsigned long kBits = 256;

// Note [fractions of the list of schemes]
// Every start of the command comes here.  Sums and products of reduced fractions would take 10 ms,
// nearly all of it for common divisors: what is rounded anyway is an integer in units of 2^-kBits,
// rounded down from a quotient of integers that is not reduced.
Integer quotient_down(const Integer& numerator, const Integer& denominator) {
  Integer result;
  if (mpz_popcount(denominator.get_mpz_t()) == 1) {  // a power of 2
    mpz_fdiv_q_2exp(result.get_mpz_t(), numerator.get_mpz_t(),
                    mpz_scan1(denominator.get_mpz_t(), 0));
  } else {
    mpz_fdiv_q(result.get_mpz_t(), numerator.get_mpz_t(), denominator.get_mpz_t());
  }
  return result;
}

Rational in_ones(const Integer& units) {
  Rational result(units, Integer(1) << kBits);
  result.canonicalize();
  return result;
}

// In units, rounded after every power.
Integer at(const Polynomial& p, const Rational& x) {
  Integer value(0);
  for (std::size_t k = p.size(); k-- > 0;) {
    value = quotient_down(
        value * x.get_num() * p[k].get_den() + Integer(p[k].get_num() << kBits) * x.get_den(),
        x.get_den() * p[k].get_den());
  }
  return value;
}

Polynomial derivative(const Polynomial& p) {
  Polynomial result;
  for (std::size_t k = 1; k < p.size(); ++k)
    result.push_back(p[k] * Rational(static_cast<long>(k)));
  return result;
}

Polynomial integral(const Polynomial& p) {
  Polynomial result{Rational(0)};
  for (std::size_t k = 0; k < p.size(); ++k)
    result.push_back(p[k] / Rational(static_cast<long>(k) + 1));
  return result;
}

Polynomial product(const Polynomial& p, const Polynomial& q) {
  Polynomial result(p.size() + q.size() - 1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) result[i + j] += p[i] * q[j];
  }
  return result;
}

// On [-1, 1]: (k + 1) P_{k+1} = (2k + 1) x P_k - k P_{k-1}.
Polynomial legendre(int degree) {
  Polynomial before{Rational(0)};
  Polynomial now{Rational(1)};
  for (long k = 0; k < degree; ++k) {
    Polynomial next = product(now, {Rational(0), Rational(2 * k + 1, k + 1)});
    for (std::size_t i = 0; i < before.size(); ++i) next[i] -= Rational(k, k + 1) * before[i];
    before = std::move(now);
    now = std::move(next);
  }
  return now;
}

// Zeros from the largest down: Newton from above 1 converges downwards to the largest zero of what
// is left when those known are divided out.
std::vector<Rational> zeros(const Polynomial& p) {
  const Polynomial slope = derivative(p);
  const Integer one = Integer(1) << kBits;
  const Integer tiny = Integer(1) << 16;
  std::vector<Integer> found;  // in units
  while (found.size() + 1 < p.size()) {
    Integer x = found.empty() ? one : Integer(found.back() - tiny);
    for (int iteration = 0; iteration < 2000; ++iteration) {
      const Rational point = in_ones(x);
      // The slope over the value, less 1 / (x - zero) for every zero that is known.
      Integer numerator = at(slope, point);
      Integer denominator = at(p, point);
      if (denominator == 0) break;
      for (const Integer& zero : found) {
        const Integer distance = x - zero;
        numerator = numerator * distance - (denominator << kBits);
        denominator *= distance;
      }
      const Integer step = quotient_down(denominator << kBits, numerator);
      x -= step;
      if (abs(step) < tiny) break;
    }
    found.push_back(x);
  }
  std::vector<Rational> numbers;
  for (const Integer& zero : found) numbers.push_back(in_ones(zero));
  return numbers;
}

// Multiples of the polynomial that is 1 at node i and 0 at the others.
Polynomial lagrange(const std::vector<Rational>& nodes, std::size_t i) {
  std::vector<Integer> units = {Integer(1) << kBits};
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    if (j == i) continue;
    // Times (x - node) / width.
    const Rational& node = nodes[j];
    const Rational width = nodes[i] - node;
    const Integer divisor = node.get_den() * width.get_num();
    units.emplace_back(0);
    for (std::size_t k = units.size(); k-- > 0;) {
      const Integer below = k > 0 ? units[k - 1] : Integer(0);
      units[k] = quotient_down(
          (below * node.get_den() - units[k] * node.get_num()) * width.get_den(), divisor);
    }
  }
  Polynomial result;
  for (const Integer& c : units) result.push_back(in_ones(c));
  return result;
}

}  // namespace

RungeKutta collocation(const std::vector<Rational>& nodes) {
  RungeKutta method;
  for (const Rational& c : nodes) method.c.emplace_back(c);
  method.a.resize(nodes.size());
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const Polynomial weight = integral(lagrange(nodes, j));
    method.b.emplace_back(in_ones(at(weight, Rational(1))));
    for (std::size_t i = 0; i < nodes.size(); ++i)
      method.a[i].emplace_back(in_ones(at(weight, nodes[i])));
  }
  return method;
}

std::vector<Rational> gauss_nodes(int stages) {
  std::vector<Rational> nodes = zeros(legendre(stages));
  for (Rational& x : nodes) x = (1 - x) / 2;
  return nodes;
}

std::vector<Scheme> gauss_methods() {
  std::vector<Scheme> list;
  for (int stages = 1; stages <= 8; ++stages) {
    list.push_back({.name = fmt::format("gauss-{}", 2 * stages),
                    .description = fmt::format("Gauss collocation, {} stage{}, implicit", stages,
                                               stages == 1 ? "" : "s"),
                    .order = 2 * stages,
                    .symmetric = true,
                    .source = "Butcher 1964; HLW II.1.3; tableau computed to 70 digits",
                    .method = collocation(gauss_nodes(stages))});
  }
  return list;
}

}  // namespace hamgen
