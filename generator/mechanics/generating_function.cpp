#include "generator/mechanics/generating_function.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "generator/algebra/derivative.hpp"
#include "generator/algebra/polynomial.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/mechanics/kernel_series.hpp"
#include "generator/mechanics/operation_count.hpp"
#include "generator/mechanics/quadratic_chart.hpp"

namespace hamgen {

namespace {

Expression sum_of_powers(const std::vector<Expression>& terms) {
  const Expression h = Expression::symbol("h", kRankOfStep);
  std::vector<Expression> parts;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    parts.push_back(Expression::power(h, Expression(static_cast<long>(k))) * terms[k]);
  }
  return Expression::sum(std::move(parts));
}

using Row = std::vector<Expression>;
using Square = std::vector<Row>;

// Derivatives of an expanded polynomial: by its atoms in Horner form, then by the chain rule.
class AtomDerivatives {
 public:
  AtomDerivatives(const Expression& k, const Row& variables)
      : variables_(variables), ring_(kMostTerms), polynomial_(ring_.expand(k)) {
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      if (varies(ring_.atom(i))) atoms_.push_back(i);
    }
    for (const std::size_t i : atoms_) inner_.push_back(gradient(ring_.atom(i), variables));
  }

  [[nodiscard]] Row first() const {
    Row result(variables_.size());
    for (std::size_t i = 0; i < atoms_.size(); ++i) {
      const Expression outer = horner(ring_.atom_derivative(polynomial_, atoms_[i]));
      for (std::size_t a = 0; a < result.size(); ++a) result[a] += outer * inner_[i][a];
    }
    return result;
  }

  [[nodiscard]] Square second() const {
    const std::size_t size = variables_.size();
    Square result(size, Row(size));
    for (std::size_t i = 0; i < atoms_.size(); ++i) {
      const Polynomial slope = ring_.atom_derivative(polynomial_, atoms_[i]);
      const Expression outer = horner(slope);
      Row curvatures;
      for (const std::size_t j : atoms_)
        curvatures.push_back(horner(ring_.atom_derivative(slope, j)));
      for (std::size_t a = 0; a < size; ++a) {
        if (inner_[i][a].is_zero()) continue;
        const Row bend = gradient(inner_[i][a], variables_);
        for (std::size_t b = 0; b < size; ++b) {
          std::vector<Expression> terms{result[a][b], outer * bend[b]};
          for (std::size_t j = 0; j < atoms_.size(); ++j) {
            terms.push_back(curvatures[j] * inner_[i][a] * inner_[j][b]);
          }
          result[a][b] = Expression::sum(std::move(terms));
        }
      }
    }
    return result;
  }

  [[nodiscard]] Expression horner() const { return horner(polynomial_); }

 private:
  [[nodiscard]] Expression horner(const Polynomial& p) const {
    return ring_.horner(p, [this](const Expression& atom) { return varies(atom); });
  }
  [[nodiscard]] bool varies(const Expression& atom) const {
    const std::set<std::string> present = symbols(atom);
    return std::ranges::any_of(variables_,
                               [&](const Expression& v) { return present.contains(v.name()); });
  }

  const Row& variables_;
  PolynomialRing ring_;
  Polynomial polynomial_;
  std::vector<std::size_t> atoms_;
  Square inner_;  // d(atom)/d(variable)
};

// Gradient and Hessian in z from the derivatives in the chart, by the chain rule.
class PullBack {
 public:
  PullBack(const Chart& chart, const Row& z) {
    for (std::size_t a = 0; a < chart.symbols.size(); ++a) {
      values_[chart.symbols[a].name()] = chart.values[a];
      inner_.push_back(gradient(chart.values[a], z));
      auto& bends = bend_.emplace_back();
      for (const Expression& slope : inner_.back()) bends.push_back(gradient(slope, z));
    }
  }

  [[nodiscard]] Row first(const Row& slopes) const {
    Row result;
    for (std::size_t i = 0; i < inner_[0].size(); ++i) {
      std::vector<Expression> terms;
      for (std::size_t a = 0; a < inner_.size(); ++a) terms.push_back(slopes[a] * inner_[a][i]);
      result.push_back(Expression::sum(std::move(terms)));
    }
    return substitute(result, values_);
  }

  [[nodiscard]] SparseMatrix second(const Row& slopes, const Square& curvatures) const {
    std::vector<std::pair<int, int>> places;
    Row values;
    for (std::size_t i = 0; i < inner_[0].size(); ++i) {
      for (std::size_t j = i; j < inner_[0].size(); ++j) {
        std::vector<Expression> terms;
        for (std::size_t a = 0; a < inner_.size(); ++a) {
          terms.push_back(slopes[a] * bend_[a][i][j]);
          if (inner_[a][i].is_zero()) continue;
          std::vector<Expression> row;
          for (std::size_t b = 0; b < inner_.size(); ++b) {
            row.push_back(curvatures[a][b] * inner_[b][j]);
          }
          terms.push_back(inner_[a][i] * Expression::sum(std::move(row)));
        }
        places.emplace_back(static_cast<int>(i), static_cast<int>(j));
        values.push_back(Expression::sum(std::move(terms)));
      }
    }
    values = substitute(values, values_);
    SparseMatrix result;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (!values[k].is_zero()) result.emplace(places[k], values[k]);
    }
    return result;
  }

 private:
  Substitution values_;
  Square inner_;              // d(y_a)/d(z_i)
  std::vector<Square> bend_;  // d2(y_a)/d(z_i)d(z_j)
};

// The ways to write K and its derivatives.
enum class Writing { nested, horner, by_atoms };

const char* to_text(Writing writing) {
  switch (writing) {
    case Writing::nested:
      return "nested derivatives of H";
    case Writing::horner:
      return "a polynomial by Horner's rule";
    case Writing::by_atoms:
      return "a polynomial, its derivatives by Horner's rule";
  }
  return "";
}

// The series in one chart and one form.
struct Candidate {
  const Chart* chart = nullptr;
  Writing writing = Writing::nested;
  Row terms;
};

Row slopes(const Candidate& candidate, const Expression& k) {
  const Row& y = candidate.chart->symbols;
  switch (candidate.writing) {
    case Writing::nested:
      return gradient(k, y);
    case Writing::horner:
      return gradient(AtomDerivatives(k, y).horner(), y);
    case Writing::by_atoms:
      return AtomDerivatives(k, y).first();
  }
  return {};
}

Square curvatures(const Candidate& candidate, const Expression& k, const Row& first) {
  const Row& y = candidate.chart->symbols;
  if (candidate.writing == Writing::by_atoms) return AtomDerivatives(k, y).second();
  Square result;
  for (const Expression& slope : first) result.push_back(gradient(slope, y));
  return result;
}

std::vector<Candidate> candidates(const Expression& energy, const Chart& chart,
                                  const std::vector<SparseMatrix>& gauge, int order) {
  std::vector<Candidate> result;
  for (const SeriesForm form : {SeriesForm::nested, SeriesForm::expanded}) {
    try {
      const Row terms = generating_series(energy, chart, gauge, order, form);
      if (form == SeriesForm::nested) {
        result.push_back({&chart, Writing::nested, terms});
      } else {
        result.push_back({&chart, Writing::horner, terms});
        result.push_back({&chart, Writing::by_atoms, terms});
      }
    } catch (const TooManyTerms&) {
      // The other form may do.
    }
  }
  return result;
}

// The Hessian is needed approximately only: that of K itself, of a shorter K, or of H.  The better
// it is, the fewer evaluations Newton's iteration takes from an extrapolated start to round-off.
struct HessianChoice {
  int order = 0;
  double evaluations = 0;  // per step, as seen on the shipped models
};

// Operations of Newton's linear system.  With a Hessian that does not couple q and p, one half of
// the unknowns is given by the other.
long solve_cost(const SparseMatrix& hessian, int n) {
  const bool separable = std::ranges::none_of(
      hessian, [n](const auto& entry) { return entry.first.first < n && entry.first.second >= n; });
  const long written_out = 3;
  const long m = separable && n <= written_out ? n : 2 * n;
  return m <= written_out ? 5 * m * m : m * m * m + 10 * m;
}

// Sets the Hessian, and the operations, to the choice that costs least per step, or to that of K.
void choose_hessian(GeneratingFunction& function, const Mechanics& mechanics,
                    const Candidate& candidate, const Row& z, const std::set<std::string>& varying,
                    bool symmetric, HessianWish wish) {
  // H is the K of order 1, and of order 2 where even powers of h vanish.
  const int of_h = symmetric ? 2 : 1;
  std::vector<HessianChoice> choices{{of_h, 4.0}, {function.order, 2.0}};
  if (function.order > 4) choices.push_back({4, 3.0});
  // Many second derivatives of a long K are never the cheapest: do not even look at them.
  const long size = function.operations * static_cast<long>(z.size());
  const bool is_long = size > 4 * kMostOperations;
  if (wish == HessianWish::exact && size <= kMostOperations / 3) choices = {{function.order, 2.0}};
  // Of a quadratic H K is quadratic too, and the equations are linear: they are solved once.
  const bool is_quadratic = std::ranges::none_of(mechanics.hessian, [&](const auto& entry) {
    const std::set<std::string> names = symbols(entry.second);
    return std::ranges::any_of(names, [&](const auto& name) { return varying.contains(name); });
  });
  if (is_quadratic && !is_long) choices = {{function.order, 1.0}};
  double least = 0;
  const Row slopes_only = function.gradient;
  for (const HessianChoice& choice : choices) {
    SparseMatrix hessian = mechanics.hessian;
    if (choice.order > of_h) {
      if (is_long) break;
      const auto count = std::min<std::ptrdiff_t>(choice.order, std::ssize(candidate.terms));
      const Expression k =
          sum_of_powers({candidate.terms.begin(), candidate.terms.begin() + count});
      const Row first = slopes(candidate, k);
      hessian = PullBack(*candidate.chart, z).second(first, curvatures(candidate, k, first));
    }
    Row all = slopes_only;
    for (const auto& [place, value] : hessian) all.push_back(value);
    const long operations = operation_count(all, varying);
    const long solve = solve_cost(hessian, mechanics.degrees_of_freedom);
    const double cost = choice.evaluations * static_cast<double>(operations + solve);
    if (least > 0 && cost >= least) continue;
    least = cost;
    function.hessian = std::move(hessian);
    function.hessian_order = choice.order;
    function.operations = operations;
  }
}

// Nothing if every form of K is too long.
std::optional<GeneratingFunction> shortest_form(const Mechanics& mechanics, const SparseMatrix& c,
                                                int order, HessianWish wish) {
  const std::vector<SparseMatrix> gauge = gauge_series(c, order);
  Row z;
  std::set<std::string> varying;
  for (int i = 0; i < 2 * mechanics.degrees_of_freedom; ++i) {
    z.push_back(mechanics.variable(i));
    varying.insert(z.back().name());
  }
  const Chart coordinates = coordinate_chart(mechanics, gauge);
  std::vector<Candidate> offers = candidates(mechanics.energy, coordinates, gauge, order);
  const auto forms = quadratic_chart(mechanics, gauge);
  if (forms) {
    for (Candidate& candidate : candidates(forms->energy, forms->chart, gauge, order)) {
      offers.push_back(std::move(candidate));
    }
  }
  GeneratingFunction best{.order = order, .gradient = {}, .hessian = {}, .form = {}};
  const Candidate* chosen = nullptr;
  for (const Candidate& candidate : offers) {
    Row first =
        PullBack(*candidate.chart, z).first(slopes(candidate, sum_of_powers(candidate.terms)));
    const long operations = operation_count(first, varying);
    if (chosen != nullptr && operations >= best.operations) continue;
    chosen = &candidate;
    best.gradient = std::move(first);
    best.operations = operations;
  }
  if (chosen == nullptr || best.operations > kMostOperations) return std::nullopt;
  best.form = to_text(chosen->writing);
  if (chosen->chart != &coordinates) {
    best.form += fmt::format(" in {} quadratic forms", chosen->chart->symbols.size());
  }
  choose_hessian(best, mechanics, *chosen, z, varying, is_odd(gauge), wish);
  return best;
}

// K as sums like those of H.
GeneratingFunction function_of_kernels(const Mechanics& mechanics, const SparseMatrix& c,
                                       int order) {
  GeneratingFunction function{.order = order,
                              .gradient = {},
                              .kernels = generating_kernels(mechanics, c, order),
                              .hessian = {},
                              .hessian_order = order,
                              .form = "sums over neighbours, like H"};
  for (const Kernel& kernel : function.kernels) {
    Row all = kernel.gradient;
    for (const auto& [slots, value] : kernel.hessian) all.push_back(value);
    std::set<std::string> varying;
    for (const Slot& slot : kernel.slots) varying.insert(slot.symbol);
    function.operations += operation_count(all, varying);
  }
  return function;
}

}  // namespace

GeneratingFunction generating_function(const Mechanics& mechanics, const SparseMatrix& c, int order,
                                       HessianWish wish) {
  if (mechanics.keeps_sums()) return function_of_kernels(mechanics, c, order);
  if (auto function = shortest_form(mechanics, c, order, wish)) return std::move(*function);
  const int decrement = is_odd(gauge_series(c, order)) ? 2 : 1;
  std::string lower;
  for (int r = order - decrement; r > 2 && lower.empty(); r -= decrement) {
    if (const auto function = shortest_form(mechanics, c, r, wish)) {
      lower =
          fmt::format("--order {} takes {} operations an evaluation; ", r, function->operations);
    }
  }
  throw UsageError(
      fmt::format("--order {}: the generating function of {} takes more than {} operations, which "
                  "would keep the "
                  "compiler busy for more than ten seconds\nhelp: {}compositions and Gauss methods "
                  "of this order cost "
                  "more stages but no long formulas, see `hamgen list schemes`",
                  order, mechanics.name, kMostOperations, lower));
}

std::string to_text(const GeneratingFunction& function) {
  const std::string which = function.hessian_order == function.order
                                ? ""
                                : fmt::format(" of order {}", function.hessian_order);
  return fmt::format("K of order {} in place of H: {}; gradient and Hessian{}: {} operations\n",
                     function.order, function.form, which, function.operations);
}

}  // namespace hamgen
