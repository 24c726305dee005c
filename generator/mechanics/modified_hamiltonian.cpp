#include "generator/mechanics/modified_hamiltonian.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/algebra/derivative.hpp"
#include "generator/algebra/polynomial.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/mechanics/generating_series.hpp"
#include "generator/mechanics/taylor.hpp"

namespace hamgen {

namespace {

// For one h, Ht is autonomous and C is a constant matrix: the generating function S of its flow at
// time theta h solves
//
//   dS/d(theta) = h Ht(zbar + (1/2 - C) J grad S),   S = 0 at theta = 0,   S = h K at theta = 1
//
// With S = sum of h^N P_N(zbar, theta) and R_N the coefficient of h^N of Ht on the right without
// H_N,
//
//   H_N = K_N - integral of R_N over 0..1,   P_(N+1) = theta H_N + integral of R_N over 0..theta
class ModifiedSolver {
 public:
  ModifiedSolver(const Mechanics& mechanics, const std::vector<SparseMatrix>& gauge)
      : chart_(coordinate_chart(mechanics, gauge)),
        odd_(is_odd(gauge)),
        ring_(kMostTerms),
        taylor_([this](const Expression& symbol, int k) { return displacement(symbol, k); }) {
    for (std::size_t i = 0; i < chart_.symbols.size(); ++i) {
      place_[chart_.symbols[i].name()] = static_cast<int>(i);
    }
    slopes_.emplace_back();
  }

  // H_N from K_N.
  void solve_next(const Expression& k) {
    const int order = static_cast<int>(terms_.size());
    if (odd_ && order % 2 != 0) {
      // A symmetric step has an even Ht, and P is odd in theta and h together.
      terms_.emplace_back();
      slopes_.push_back(gradient({}, chart_.symbols));
      return;
    }
    std::vector<Expression> parts;
    for (int j = 0; j < order; ++j) {
      parts.push_back(taylor_.coefficient(terms_[static_cast<std::size_t>(j)], order - j));
    }
    const Polynomial grown = integral(ring_.expand(Expression::sum(std::move(parts))));
    const Expression over_time = normal(grown);
    const Expression at_end = substitute(over_time, {{theta_.name(), Expression(1)}});
    terms_.push_back(normal(ring_.expand(k - at_end)));
    const Expression p = normal(ring_.expand(theta_ * terms_.back() + over_time));
    slopes_.push_back(gradient(p, chart_.symbols));
  }

  [[nodiscard]] const std::vector<Expression>& terms() const { return terms_; }

 private:
  [[nodiscard]] Expression normal(const Polynomial& p) const {
    return ring_.horner(p, [this](const Expression& atom) {
      return std::ranges::any_of(symbols(atom),
                                 [this](const std::string& s) { return place_.contains(s); });
    });
  }

  // Over theta from 0.
  [[nodiscard]] Polynomial integral(const Polynomial& p) {
    const Polynomial factor = ring_.expand(theta_);
    const std::size_t atom = factor.begin()->first.size() - 1;
    Polynomial result;
    for (const auto& [monomial, coefficient] : p) {
      const int exponent = atom < monomial.size() ? monomial[atom] : 0;
      accumulate(result, ring_.product({{monomial, coefficient}}, factor),
                 Rational(1, exponent + 1));
    }
    return result;
  }

  // The coefficient of h^k of component i of (1/2 - C) J grad S.
  [[nodiscard]] Expression displacement(const Expression& symbol, int k) {
    const auto it = place_.find(symbol.name());
    if (it == place_.end()) return {};
    const int i = it->second;
    std::vector<Expression> parts;
    for (int l = 0; l < k; ++l) {
      const SparseMatrix& table = chart_.displacements[static_cast<std::size_t>(l)];
      for (auto entry = table.lower_bound({i, 0}); entry != table.end() && entry->first.first == i;
           ++entry) {
        const auto& slopes = slopes_[static_cast<std::size_t>(k - l)];
        parts.push_back(entry->second * slopes[static_cast<std::size_t>(entry->first.second)]);
      }
    }
    return Expression::sum(std::move(parts));
  }

  Chart chart_;
  bool odd_;
  PolynomialRing ring_;
  TaylorSeries taylor_;
  std::map<std::string, int> place_;
  Expression theta_ = Expression::symbol("theta of the flow", kRankOfStep);
  std::vector<Expression> terms_;
  std::vector<std::vector<Expression>> slopes_;  // of P_N, from place 1
};

}  // namespace

std::vector<Expression> modified_hamiltonian(const Mechanics& mechanics, const SparseMatrix& c,
                                             int order, int count) {
  const int raised = std::max(order, 1);
  const auto gauge = gauge_series(c, std::max(count, raised));
  try {
    const std::vector<Expression> k =
        generating_series(mechanics.energy, coordinate_chart(mechanics, gauge), gauge,
                          std::min(raised, count), SeriesForm::expanded);
    ModifiedSolver solver(mechanics, gauge);
    for (std::size_t j = 0; j < static_cast<std::size_t>(count); ++j) {
      solver.solve_next(j < k.size() ? k[j] : Expression(0));
    }
    return solver.terms();
  } catch (const TooManyTerms&) {
    throw UsageError(fmt::format(
        "the modified Hamiltonian of {} has more than {} terms at h^{}\nhelp: ask for fewer terms",
        mechanics.name, kMostTerms, count - 1));
  }
}

}  // namespace hamgen
