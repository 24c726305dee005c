#include "generator/mechanics/quadratic_chart.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/mechanics/generating_series.hpp"

namespace hamgen {

namespace {

using Matrix = std::map<std::pair<int, int>, Rational>;  // nonzero entries

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result;
  for (const auto& [left, x] : a) {
    for (auto it = b.lower_bound({left.second, 0}); it != b.end() && it->first.first == left.second;
         ++it) {
      result[{left.first, it->first.second}] += x * it->second;
    }
  }
  std::erase_if(result, [](const auto& entry) { return entry.second == 0; });
  return result;
}

Matrix transpose(const Matrix& a) {
  Matrix result;
  for (const auto& [place, x] : a) result[{place.second, place.first}] = x;
  return result;
}

// (a + a^T)/2: the same quadratic form.
Matrix symmetric_part(const Matrix& a) {
  Matrix result;
  for (const auto& [place, x] : a) {
    result[place] += x / 2;
    result[{place.second, place.first}] += x / 2;
  }
  std::erase_if(result, [](const auto& entry) { return entry.second == 0; });
  return result;
}

// A matrix of expressions as a sum of expression times numbers: equal entries go together.
using Parts = std::vector<std::pair<Expression, Matrix>>;

Parts parts_of(const SparseMatrix& m) {
  std::map<Expression, Matrix> parts;
  for (const auto& [place, value] : m) {
    const auto [number, rest] = value.split_coefficient();
    parts[rest][place] = number;
  }
  return {parts.begin(), parts.end()};
}

class FormBuilder {
 public:
  explicit FormBuilder(const Mechanics& mechanics)
      : mechanics_(mechanics), size_(2 * mechanics.degrees_of_freedom) {
    for (int i = 0; i < size_; ++i) place_[mechanics.variable(i).name()] = i;
  }

  // H in the symbols of forms; nothing if something else is left.
  std::optional<Expression> rewrite(const Expression& e) {
    if (e.is_number()) return e;
    if (e.kind() == Kind::symbol) {
      if (place_.contains(e.name())) return std::nullopt;
      return e;
    }
    if (e.kind() == Kind::sum) return rewrite_sum(e);
    if (const auto term = quadratic_term(e)) return term->factor * form(term->form);
    std::vector<Expression> operands;
    for (const Expression& operand : e.operands()) {
      const auto inner = rewrite(operand);
      if (!inner) return std::nullopt;
      operands.push_back(*inner);
    }
    return with_operands(e, std::move(operands));
  }

  // factor * (the form z^T n z), as a multiple of a form that is known from now on.
  Expression form(const Matrix& n) {
    if (n.empty()) return {};
    for (std::size_t a = 0; a < forms_.size(); ++a) {
      if (const auto ratio = quotient(n, forms_[a])) return Expression(*ratio) * symbol(a);
    }
    forms_.push_back(n);
    return symbol(forms_.size() - 1);
  }

  [[nodiscard]] const std::vector<Matrix>& forms() const { return forms_; }
  [[nodiscard]] bool too_many() const { return static_cast<int>(forms_.size()) > size_ + 1; }

  [[nodiscard]] Expression symbol(std::size_t a) const {
    return Expression::symbol(fmt::format("form {}", a + 1),
                              kRankOfVariable + size_ + static_cast<int>(a));
  }
  [[nodiscard]] Expression value(std::size_t a) const {
    std::vector<Expression> terms;
    for (const auto& [place, x] : forms_[a]) {
      terms.push_back(Expression(x) * mechanics_.variable(place.first) *
                      mechanics_.variable(place.second));
    }
    return Expression::sum(std::move(terms));
  }

 private:
  struct Term {
    Expression factor;  // without coordinates and momenta
    Matrix form;
  };

  // c z_i z_j, or nothing.
  std::optional<Term> quadratic_term(const Expression& e) const {
    Term term{Expression(1), {}};
    std::vector<int> variables;
    Rational number = 1;
    const auto factors = e.kind() == Kind::product ? e.operands() : std::span(&e, 1);
    for (const Expression& factor : factors) {
      const bool square = factor.kind() == Kind::power && factor.operands()[1] == Expression(2);
      const Expression& base = square ? factor.operands()[0] : factor;
      const auto it = base.kind() == Kind::symbol ? place_.find(base.name()) : place_.end();
      if (it != place_.end()) {
        variables.insert(variables.end(), square ? 2 : 1, it->second);
      } else if (factor.is_number()) {
        number = factor.number();
      } else if (std::ranges::any_of(symbols(factor),
                                     [&](const auto& name) { return place_.contains(name); })) {
        return std::nullopt;
      } else {
        term.factor = term.factor * factor;
      }
    }
    if (variables.size() != 2) return std::nullopt;
    term.form[{variables[0], variables[1]}] = number;
    term.form = symmetric_part(term.form);
    return term;
  }

  std::optional<Expression> rewrite_sum(const Expression& e) {
    std::map<Expression, Matrix> groups;  // forms by their factor
    std::vector<Expression> terms;
    for (const Expression& operand : e.operands()) {
      if (const auto term = quadratic_term(operand)) {
        for (const auto& [place, x] : term->form) groups[term->factor][place] += x;
      } else if (const auto inner = rewrite(operand)) {
        terms.push_back(*inner);
      } else {
        return std::nullopt;
      }
    }
    for (const auto& [factor, matrix] : groups) terms.push_back(factor * form(matrix));
    return Expression::sum(std::move(terms));
  }

  static std::optional<Rational> quotient(const Matrix& a, const Matrix& b) {
    if (a.size() != b.size()) return std::nullopt;
    const Rational ratio = a.begin()->second / b.begin()->second;
    const bool equal = std::ranges::equal(a, b, [&](const auto& x, const auto& y) {
      return x.first == y.first && x.second == ratio * y.second;
    });
    if (!equal) return std::nullopt;
    return ratio;
  }

  const Mechanics& mechanics_;
  int size_;
  std::map<std::string, int> place_;
  std::vector<Matrix> forms_;
};

// (x 2 N_b z)^T y for the symmetric matrices of forms, as a form: z^T (4 N_a M N_b) z.
Matrix sandwich(const Matrix& a, const Matrix& m, const Matrix& b) {
  Matrix result = symmetric_part(product(a, product(m, b)));
  for (auto& [place, x] : result) x *= 4;
  return result;
}

}  // namespace

std::optional<QuadraticChart> quadratic_chart(const Mechanics& mechanics,
                                              const std::vector<SparseMatrix>& gauge) {
  FormBuilder builder(mechanics);
  const auto energy = builder.rewrite(mechanics.energy);
  if (!energy || builder.forms().empty()) return std::nullopt;
  const Chart coordinates = coordinate_chart(mechanics, gauge);
  std::vector<Parts> displacements;
  std::vector<Parts> gauges;
  for (const SparseMatrix& m : coordinates.displacements) displacements.push_back(parts_of(m));
  for (const SparseMatrix& m : coordinates.gauges) gauges.push_back(parts_of(m));
  QuadraticChart result{.chart = {}, .energy = *energy};
  // New forms have products of their own: until none appear.
  for (std::size_t known = 0; known != builder.forms().size();) {
    known = builder.forms().size();
    if (builder.too_many()) return std::nullopt;
    Chart& chart = result.chart;
    chart = Chart{};
    const auto table = [&](const std::vector<Parts>& series, std::vector<SparseMatrix>& tables) {
      for (const Parts& parts : series) {
        SparseMatrix& entries = tables.emplace_back();
        for (std::size_t a = 0; a < known; ++a) {
          for (std::size_t b = 0; b < known; ++b) {
            Expression sum;
            for (const auto& [factor, m] : parts) {
              sum += factor * builder.form(sandwich(builder.forms()[a], m, builder.forms()[b]));
            }
            if (!sum.is_zero()) entries[{static_cast<int>(a), static_cast<int>(b)}] = sum;
          }
        }
      }
    };
    table(displacements, chart.displacements);
    table(gauges, chart.gauges);
    for (std::size_t l = 0; l < displacements.size(); ++l) {
      for (std::size_t m = 0; m < displacements.size(); ++m) {
        std::vector<SparseMatrix> tables(known);
        bool any = false;
        for (std::size_t a = 0; a < known; ++a) {
          for (std::size_t b = 0; b < known; ++b) {
            for (std::size_t c = 0; c < known; ++c) {
              Expression sum;
              for (const auto& [left, x] : displacements[l]) {
                for (const auto& [right, y] : displacements[m]) {
                  // (x 2 N_b z)^T (2 N_a) (y 2 N_c z).
                  Matrix inner = product(transpose(x), product(builder.forms()[a], y));
                  for (auto& [place, value] : inner) value *= 2;
                  sum += left * right *
                         builder.form(sandwich(builder.forms()[b], inner, builder.forms()[c]));
                }
              }
              if (sum.is_zero()) continue;
              tables[a][{static_cast<int>(b), static_cast<int>(c)}] = sum;
              any = true;
            }
          }
        }
        if (any) {
          chart.curvatures[{static_cast<int>(l), static_cast<int>(m)}] = std::move(tables);
        }
      }
    }
  }
  for (std::size_t a = 0; a < builder.forms().size(); ++a) {
    result.chart.symbols.push_back(builder.symbol(a));
    result.chart.values.push_back(builder.value(a));
  }
  return result;
}

}  // namespace hamgen
