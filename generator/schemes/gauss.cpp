// Collocation at the zeros of the shifted Legendre polynomial: order 2 s with s stages.
#include <fmt/format.h>

#include "generator/schemes/all_schemes.hpp"

namespace hamgen {

namespace {

using Polynomial = std::vector<Rational>;  // coefficients of 1, x, x^2, ...

// 77 digits: twice those of the widest scalar.
constexpr unsigned long kBits = 256;

Rational rounded(const Rational& value) {
  Integer scaled = value.get_num() << kBits;
  mpz_fdiv_q(scaled.get_mpz_t(), scaled.get_mpz_t(), value.get_den_mpz_t());
  Rational result(scaled, Integer(1) << kBits);
  result.canonicalize();
  return result;
}

Rational at(const Polynomial& p, const Rational& x) {
  Rational value(0);
  for (std::size_t k = p.size(); k-- > 0;) value = rounded(value * x + p[k]);
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
  std::vector<Rational> found;
  const Rational tiny(Integer(1), Integer(1) << (kBits - 16));
  while (found.size() + 1 < p.size()) {
    Rational x = found.empty() ? Rational(1) : found.back();
    if (!found.empty()) x -= tiny;
    for (int iteration = 0; iteration < 2000; ++iteration) {
      const Rational value = at(p, x);
      if (value == 0) break;
      Rational quotient = at(slope, x) / value;
      for (const Rational& zero : found) quotient -= 1 / (x - zero);
      const Rational step = rounded(1 / quotient);
      x -= step;
      if (abs(step) < tiny) break;
    }
    found.push_back(x);
  }
  return found;
}

// Multiples of the polynomial that is 1 at node i and 0 at the others.
Polynomial lagrange(const std::vector<Rational>& nodes, std::size_t i) {
  Polynomial result{Rational(1)};
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    if (j == i) continue;
    const Rational width = nodes[i] - nodes[j];
    result = product(result, {Rational(-nodes[j] / width), Rational(1 / width)});
    for (Rational& c : result) c = rounded(c);
  }
  return result;
}

}  // namespace

RungeKutta collocation(const std::vector<Rational>& nodes) {
  RungeKutta method;
  for (const Rational& c : nodes) method.c.emplace_back(c);
  method.a.resize(nodes.size());
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const Polynomial weight = integral(lagrange(nodes, j));
    method.b.emplace_back(at(weight, Rational(1)));
    for (std::size_t i = 0; i < nodes.size(); ++i) method.a[i].emplace_back(at(weight, nodes[i]));
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
