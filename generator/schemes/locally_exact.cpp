#include "generator/schemes/locally_exact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "generator/algebra/derivative.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/constant.hpp"
#include "generator/schemes/matrix_function.hpp"

namespace hamgen {

namespace {

// C is dense within the degrees of freedom that H'' couples: its text grows as their third power.
constexpr std::size_t kMostCoupled = 24;

// What the reference says, in short: the coordinates that are not 0 and the parameters H'' uses.
std::string place_text(const Mechanics& mechanics, const Values& reference) {
  std::set<std::string> used;
  for (const auto& [place, value] : mechanics.hessian) collect_symbols(value, used);
  std::string text;
  for (const Quantity& variable : mechanics.variables) {
    const Rational& value = reference.at(variable.name);
    if (sgn(value) != 0 && used.contains(variable.name)) {
      text += fmt::format(", {} = {}", variable.name, short_text(value));
    }
  }
  text = text.empty() ? "at the origin" : "at" + text.substr(1);
  for (const Quantity& parameter : mechanics.parameters) {
    if (!used.contains(parameter.name)) continue;
    text += fmt::format(", {} = {}", parameter.name, short_text(reference.at(parameter.name)));
  }
  return text;
}

// A point where H'' has a value: one coordinate away from the origin, or all of them apart.
std::string other_point(const Mechanics& mechanics, const Values& reference) {
  const auto n = static_cast<std::size_t>(mechanics.degrees_of_freedom);
  constexpr std::size_t most = 8;
  for (const std::size_t moved : {std::size_t{1}, n}) {
    Values point = reference;
    std::string text;
    for (std::size_t i = 0; i < mechanics.variables.size(); ++i) {
      const std::string& name = mechanics.variables.name(i);
      point[name] = i < moved ? static_cast<long>(i + 1) : 0L;
      if (i < moved) text += fmt::format("{}{}={}", i == 0 ? "" : ",", name, i + 1);
    }
    const bool is_defined = std::ranges::all_of(mechanics.hessian, [&point](const auto& entry) {
      return evaluate(entry.second, point).has_value();
    });
    if (is_defined && moved <= most) return ", for example --reference " + text;
  }
  return " with --reference; without it the initial state of the scene is taken";
}

// J H'' at the reference.
RationalMatrix linear_part(const Mechanics& mechanics, const Values& reference) {
  const auto n = static_cast<std::size_t>(mechanics.degrees_of_freedom);
  RationalMatrix a(2 * n, std::vector<Rational>(2 * n));
  for (const auto& [place, derivative] : mechanics.hessian) {
    const auto [first, second] = place;
    const std::optional<Rational> value = evaluate(derivative, reference);
    if (!value) {
      throw UsageError(fmt::format(
          "--gauge locally-exact: the second derivative of H by {} and {} is not defined {}\n"
          "help: choose another point{}",
          mechanics.variables.name(static_cast<std::size_t>(first)),
          mechanics.variables.name(static_cast<std::size_t>(second)),
          place_text(mechanics, reference), other_point(mechanics, reference)));
    }
    for (const auto& [i, j] : {std::pair(first, second), std::pair(second, first)}) {
      const auto row = static_cast<std::size_t>(i);
      const auto column = static_cast<std::size_t>(j);
      // J = [[0, I], [-I, 0]].
      a[row < n ? row + n : row - n][column] = row < n ? Rational(-*value) : *value;
    }
  }
  return a;
}

// The degrees of freedom that A couples, directly or not: each is a set, in ascending order.
std::vector<std::vector<std::size_t>> coupled_sets(const RationalMatrix& a) {
  const std::size_t n = a.size() / 2;
  std::vector<std::size_t> root(n);
  for (std::size_t i = 0; i < n; ++i) root[i] = i;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    for (std::size_t j = 0; j < 2 * n; ++j) {
      if (sgn(a[i][j]) == 0 || root[i % n] == root[j % n]) continue;
      const std::size_t from = std::max(root[i % n], root[j % n]);
      const std::size_t to = std::min(root[i % n], root[j % n]);
      std::ranges::replace(root, from, to);
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> sets;
  for (std::size_t i = 0; i < n; ++i) sets[root[i]].push_back(i);
  std::vector<std::vector<std::size_t>> result;
  for (auto& [first, set] : sets) result.push_back(std::move(set));
  return result;
}

// Adds a term to C at the places of the set, entry and mirror image from one number: then
// C J + J C^T = 0 holds exactly, not only to the digits of the term.
void add_term(const MatrixTerm& term, const std::vector<std::size_t>& set, std::size_t n,
              SparseMatrix& c) {
  const std::size_t m = set.size();
  const RationalMatrix& f = term.matrix;
  const auto add = [&](std::size_t row, std::size_t column, const Rational& value) {
    if (sgn(value) == 0) return;
    Expression& entry = c[{static_cast<int>(row), static_cast<int>(column)}];
    entry = entry + Expression(value) * term.function;
  };
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < m; ++j) {
      add(set[i], set[j], f[i][j]);
      add(n + set[j], n + set[i], -f[i][j]);
      const std::size_t low = std::min(i, j);
      const std::size_t high = std::max(i, j);
      add(set[i], n + set[j], f[low][m + high]);
      add(n + set[i], set[j], f[m + low][high]);
    }
  }
}

RationalMatrix restricted(const RationalMatrix& a, const std::vector<std::size_t>& set) {
  const std::size_t m = set.size();
  const std::size_t n = a.size() / 2;
  const auto at = [&](std::size_t i) { return i < m ? set[i] : n + set[i - m]; };
  RationalMatrix result(2 * m, std::vector<Rational>(2 * m));
  for (std::size_t i = 0; i < 2 * m; ++i) {
    for (std::size_t j = 0; j < 2 * m; ++j) result[i][j] = a[at(i)][at(j)];
  }
  return result;
}

void find_symbols(const Expression& e, ExpressionMap<bool>& seen,
                  std::map<std::string, Expression>& symbols) {
  if (!seen.emplace(e, true).second) return;
  if (e.kind() == Kind::symbol) symbols.emplace(e.name(), e);
  for (const Expression& operand : e.operands()) find_symbols(operand, seen, symbols);
}

[[noreturn]] void throw_dense(std::size_t coupled) {
  throw UsageError(fmt::format(
      "--gauge locally-exact: the linear part couples {} degrees of freedom, more than {}\n"
      "help: its matrix would be dense; take the midpoint rule, or another --reference",
      coupled, kMostCoupled));
}

std::string pole_text(const std::vector<double>& steps) {
  if (steps.empty()) return "";
  constexpr std::size_t most = 3;
  std::string text = "; poles at multiples of h =";
  for (std::size_t i = 0; i < std::min(most, steps.size()); ++i) {
    text += fmt::format("{} {:.4g}", i == 0 ? "" : ",", steps[i]);
  }
  return steps.size() > most ? text + ", ..." : text;
}

}  // namespace

void require_sparse_row(const Expression& hamiltonian, const std::vector<std::string>& coordinates,
                        const std::vector<std::string>& momenta, const Values& reference) {
  ExpressionMap<bool> seen;
  std::map<std::string, Expression> symbols;
  find_symbols(hamiltonian, seen, symbols);
  const auto first = symbols.find(coordinates.front());
  if (first == symbols.end()) return;
  const Expression slope = derivative(hamiltonian, first->second);
  std::vector<std::size_t> places;
  std::vector<Expression> variables;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    for (const std::string& name : {coordinates[i], momenta[i]}) {
      if (!symbols.contains(name)) continue;
      places.push_back(i);
      variables.push_back(symbols.at(name));
    }
  }
  const std::vector<Expression> row = gradient(slope, variables);
  std::set<std::size_t> coupled = {0};
  for (std::size_t k = 0; k < row.size(); ++k) {
    const std::optional<Rational> value = evaluate(row[k], reference);
    if (value && sgn(*value) != 0) coupled.insert(places[k]);
  }
  if (coupled.size() > kMostCoupled) throw_dense(coupled.size());
}

Scheme locally_exact_member(const Mechanics& mechanics, const Values& reference) {
  const RationalMatrix a = linear_part(mechanics, reference);
  const auto n = static_cast<std::size_t>(mechanics.degrees_of_freedom);
  Member member{.degrees_of_freedom = mechanics.degrees_of_freedom};
  for (const std::vector<std::size_t>& set : coupled_sets(a)) {
    if (set.size() > kMostCoupled) throw_dense(set.size());
    const MatrixFunction f = gauge_function(restricted(a, set));
    for (const MatrixTerm& term : f.terms) add_term(term, set, n, member.c);
    for (const Rational& w : f.frequencies) {
      const double step = 2 * std::numbers::pi / to_double(w);
      if (std::ranges::find(member.singular_steps, step) == member.singular_steps.end()) {
        member.singular_steps.push_back(step);
      }
    }
  }
  std::erase_if(member.c, [](const auto& entry) { return entry.second.is_zero(); });
  std::ranges::sort(member.singular_steps);
  Scheme scheme{.name = "locally-exact", .order = 2, .symmetric = true};
  scheme.description =
      fmt::format("C = (h A)^-1 - coth(h A/2)/2, A = J H'' {}{}", place_text(mechanics, reference),
                  pole_text(member.singular_steps));
  scheme.source = "I/2 + C = (hA)^-1 - (exp(hA) - 1)^-1 makes the linear step exp(hA)";
  scheme.method = std::move(member);
  return scheme;
}

}  // namespace hamgen
