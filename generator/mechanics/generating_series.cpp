#include "generator/mechanics/generating_series.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/algebra/derivative.hpp"
#include "generator/algebra/polynomial.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/mechanics/operation_count.hpp"
#include "generator/mechanics/step_series.hpp"
#include "generator/mechanics/taylor.hpp"

namespace hamgen {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Expression step() { return Expression::symbol("h", kRankOfStep); }

Expression at_zero(const Expression& e) { return substitute(e, {{"h", Expression(0)}}); }

// Is there a reciprocal of zero in it?
bool is_undefined(const Expression& e) {
  if (e.kind() == Kind::power && e.operands()[0].is_zero()) return true;
  return std::ranges::any_of(e.operands(), is_undefined);
}

// Is there one at h = 0?  In a product with a zero, as of tan(h)/h, nothing would be left of it.
bool divides_by_zero(const Expression& e) {
  if (!depends_on(e, "h")) return false;
  if (e.kind() == Kind::power && at_zero(e.operands()[0]).is_zero() && is_undefined(at_zero(e))) {
    return true;
  }
  return std::ranges::any_of(e.operands(), divides_by_zero);
}

// M J with J = [[0, I], [-I, 0]]: its column j is -(column n + j of M), its column n + j is column
// j.
SparseMatrix times_j(const SparseMatrix& m, int n) {
  SparseMatrix result;
  for (const auto& [place, value] : m) {
    const auto [row, column] = place;
    if (column < n) {
      result[{row, n + column}] = value;
    } else {
      result[{row, column - n}] = -value;
    }
  }
  return result;
}

}  // namespace

std::vector<SparseMatrix> gauge_series(const SparseMatrix& c, int count) {
  std::vector<SparseMatrix> series(at(count));
  const auto without_series = [](const Expression& entry) {
    return UsageError(fmt::format(
        "alpha, beta and gamma must have a power series in h here: the entry {} of C has none at "
        "h = 0",
        to_text(entry)));
  };
  for (const auto& [place, value] : c) {
    if (has_corner(value)) throw without_series(value);
    if (divides_by_zero(value)) {
      // It may still have a limit, and a series.
      if (const auto limits = step_series(value, count)) {
        for (int l = 0; l < count; ++l) {
          if (!(*limits)[at(l)].is_zero()) series[at(l)][place] = (*limits)[at(l)];
        }
        continue;
      }
    }
    Expression derivative_of_entry = value;
    Rational factorial = 1;
    for (int l = 0; l < count; ++l) {
      if (l > 0) {
        derivative_of_entry = derivative(derivative_of_entry, step());
        factorial *= l;
      }
      const Expression coefficient = at_zero(derivative_of_entry);
      if (is_undefined(coefficient)) throw without_series(value);
      if (!coefficient.is_zero()) {
        series[at(l)][place] = coefficient * Expression(Rational(1 / factorial));
      }
    }
  }
  return series;
}

bool is_odd(const std::vector<SparseMatrix>& gauge) {
  for (std::size_t l = 0; l < gauge.size(); l += 2) {
    if (!gauge[l].empty()) return false;
  }
  return true;
}

Chart coordinate_chart(const Mechanics& mechanics, const std::vector<SparseMatrix>& gauge) {
  std::vector<Expression> symbols;
  for (int i = 0; i < 2 * mechanics.degrees_of_freedom; ++i)
    symbols.push_back(mechanics.variable(i));
  return coordinate_chart(std::move(symbols), gauge);
}

Chart coordinate_chart(std::vector<Expression> symbols, const std::vector<SparseMatrix>& gauge) {
  const auto n = static_cast<int>(symbols.size() / 2);
  Chart chart{.symbols = std::move(symbols),
              .values = {},
              .displacements = {},
              .gauges = {},
              .curvatures = {}};
  chart.values = chart.symbols;
  for (std::size_t l = 0; l < gauge.size(); ++l) {
    // D = 1/2 - C.
    SparseMatrix d;
    for (const auto& [place, value] : gauge[l]) d[place] = -value;
    for (int i = 0; l == 0 && i < 2 * n; ++i) d[{i, i}] += Expression(Rational(1, 2));
    std::erase_if(d, [](const auto& entry) { return entry.second.is_zero(); });
    chart.displacements.push_back(times_j(d, n));
    chart.gauges.push_back(times_j(gauge[l], n));
  }
  return chart;
}

namespace {

// Solves for S term by term.
class SeriesSolver {
 public:
  SeriesSolver(const Expression& energy, const Chart& chart, PolynomialRing* ring)
      : energy_(energy),
        chart_(chart),
        ring_(ring),
        taylor_([this](const Expression& symbol, int k) { return displacement(symbol, k); }) {
    for (std::size_t a = 0; a < chart.symbols.size(); ++a) {
      place_[chart.symbols[a].name()] = static_cast<int>(a);
      varying_.insert(chart.symbols[a].name());
    }
    slopes_.emplace_back();
    terms_.emplace_back();
    append(energy);
  }

  // (k + 1) S_(k+1) = coefficient of h^k of the right side.
  void solve_next(bool vanishes) {
    const int k = static_cast<int>(terms_.size()) - 1;
    if (vanishes) {
      append({});
      return;
    }
    std::vector<Expression> parts{taylor_.coefficient(energy_, k)};
    for (int l = 0; l + 2 <= k; ++l) {
      const SparseMatrix& gauge = chart_.gauges[at(l + 1)];
      for (int i = 1; i + l < k; ++i) {
        for (const auto& [place, value] : gauge) {
          parts.push_back(Expression(Rational(-(l + 1), 2)) * value * slope(i, place.first) *
                          slope(k - l - i, place.second));
        }
      }
    }
    append(normal(Expression(Rational(1, k + 1)) * Expression::sum(std::move(parts))));
  }

  [[nodiscard]] std::vector<Expression> terms() const { return {terms_.begin() + 1, terms_.end()}; }

 private:
  [[nodiscard]] Expression normal(const Expression& e) {
    if (ring_ == nullptr) return e;
    return ring_->horner(ring_->expand(e), [&](const Expression& atom) { return varies(atom); });
  }

  [[nodiscard]] bool varies(const Expression& atom) const {
    for (const std::string& name : symbols(atom)) {
      if (place_.contains(name)) return true;
    }
    return false;
  }

  void append(const Expression& term) {
    terms_.push_back(term);
    slopes_.push_back(gradient(term, chart_.symbols));
    if (operation_count(slopes_.back(), varying_) > kMostOperations) throw TooManyTerms();
  }

  [[nodiscard]] const Expression& slope(int k, int a) const { return slopes_[at(k)][at(a)]; }

  // The coefficient of h^k of y_a(z + w).
  [[nodiscard]] Expression displacement(const Expression& symbol, int k) {
    const auto it = place_.find(symbol.name());
    if (it == place_.end()) return {};
    const int a = it->second;
    std::vector<Expression> parts;
    for (int l = 0; l < k; ++l) {
      const SparseMatrix& table = chart_.displacements[at(l)];
      for (auto entry = table.lower_bound({a, 0}); entry != table.end() && entry->first.first == a;
           ++entry) {
        parts.push_back(entry->second * slope(k - l, entry->first.second));
      }
    }
    const Expression half(Rational(1, 2));
    for (const auto& [powers, tables] : chart_.curvatures) {
      const int left = k - powers.first - powers.second;
      for (const auto& [place, value] : tables[at(a)]) {
        for (int i = 1; i < left; ++i) {
          parts.push_back(half * value * slope(i, place.first) * slope(left - i, place.second));
        }
      }
    }
    return normal(Expression::sum(std::move(parts)));
  }

  const Expression& energy_;
  const Chart& chart_;
  PolynomialRing* ring_;
  TaylorSeries taylor_;
  std::map<std::string, int> place_;
  std::set<std::string> varying_;
  std::vector<Expression> terms_;                // from S_1 on at place 1
  std::vector<std::vector<Expression>> slopes_;  // dS_k/dy_a
};

}  // namespace

std::vector<Expression> generating_series(const Expression& energy, const Chart& chart,
                                          const std::vector<SparseMatrix>& gauge, int count,
                                          SeriesForm form) {
  PolynomialRing ring(kMostTerms);
  SeriesSolver solver(energy, chart, form == SeriesForm::expanded ? &ring : nullptr);
  // A symmetric member has a series in odd powers: the others cancel, which the nested form hides.
  const bool odd = is_odd(gauge);
  for (int k = 2; k <= count; ++k) solver.solve_next(odd && k % 2 == 0);
  return solver.terms();
}

}  // namespace hamgen
