#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "generator/algebra/evaluate.hpp"
#include "generator/algebra/from_ginac.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/mechanics/step_series.hpp"
#include "generator/schemes/all_schemes.hpp"

namespace hamgen {

namespace {

// The block as a matrix: nonzero entries.
SparseMatrix block_matrix(const char* name, const GaugeBlock& block, int n) {
  const std::vector<Expression>& entries = block.entries;
  const auto size = static_cast<std::size_t>(n);
  SparseMatrix matrix;
  if (block.is_matrix) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      if (entries[k].is_zero()) continue;
      matrix.emplace(std::pair(static_cast<int>(k / size), static_cast<int>(k % size)), entries[k]);
    }
    return matrix;
  }
  if (entries.size() != 1 && entries.size() != size) {
    throw UsageError(
        fmt::format("--{} has {} values; give 1{}", name, entries.size(),
                    n == 1 ? "" : fmt::format(", or {}: one per degree of freedom", n)));
  }
  for (std::size_t i = 0; i < size; ++i) {
    const Expression& value = entries.size() == 1 ? entries[0] : entries[i];
    if (!value.is_zero())
      matrix.emplace(std::pair(static_cast<int>(i), static_cast<int>(i)), value);
  }
  return matrix;
}

Expression entry(const SparseMatrix& matrix, int i, int j) {
  const auto it = matrix.find({i, j});
  return it == matrix.end() ? Expression(0) : it->second;
}

void require_symmetric(const char* name, const SparseMatrix& matrix) {
  for (const auto& [place, value] : matrix) {
    const auto [i, j] = place;
    const Expression mirror = entry(matrix, j, i);
    if (value == mirror || vanishes(value - mirror)) continue;
    throw UsageError(fmt::format(
        "--{0}: entry ({1}, {2}) is {3}, but entry ({2}, {1}) is {4}\n"
        "help: the {0} block must be symmetric: C has to lie in sp(2n), C J + J C^T = 0, or the "
        "step is not symplectic",
        name, i + 1, j + 1, to_text(value), to_text(mirror)));
  }
}

// The expression with h replaced by -h.
Expression reflected(const Expression& e) {
  return substitute(e, {{"h", -Expression::symbol("h")}});
}

// The different entries: a large system has few.
std::set<Expression> distinct_entries(const SparseMatrix& c) {
  std::set<Expression> entries;
  for (const auto& [place, value] : c) entries.insert(value);
  return entries;
}

bool vanishes_with_h(const SparseMatrix& c) {
  for (const Expression& value : distinct_entries(c)) {
    const std::optional<Expression> limit = at_zero_step(value);
    if (!limit || !vanishes(*limit)) return false;
  }
  return true;
}

// Is C = value * [[I, 0], [0, -I]]?
bool is_diagonal_gauge(const Member& member, const Expression& value) {
  const std::optional<FamilyParameters> parameters = uniform_parameters(member);
  return parameters && parameters->beta.is_zero() && parameters->gamma.is_zero() &&
         parameters->alpha == value;
}

// At points of both signs where a nonzero expression of h, E0 and parameters is hardly zero; to
// 1e-30.  A guess: `verify` says how well it is known.
bool looks_zero(const Expression& e) {
  std::set<std::string> names;
  collect_symbols(e, names);
  int defined = 0;
  for (int k = 1; k <= 8; ++k) {
    Values values;
    int i = 0;
    for (const std::string& name : names) {
      ++i;
      const int sign = (k >> (i % 3)) % 2 == 0 ? 1 : -1;
      values[name] = sign * Rational(2 * i + k) / Rational(7 + 3 * i * k);
    }
    const std::optional<Rational> value = evaluate(e, values);
    if (!value) continue;
    ++defined;
    if (std::abs(to_double(*value)) > 1e-30) return false;
  }
  return defined > 0;
}

bool is_odd_in_h(const SparseMatrix& c) {
  return std::ranges::all_of(distinct_entries(c), [](const Expression& value) {
    const Expression sum = reflected(value) + value;
    return vanishes(sum) || looks_zero(sum);
  });
}

Scheme member_scheme(int degrees_of_freedom, SparseMatrix c) {
  Scheme scheme;
  Member member{.degrees_of_freedom = degrees_of_freedom, .c = std::move(c)};
  // Mathematics: the adjoint of C is -C, so C(-h) = -C(h) makes the member symmetric; order 2 needs
  // C = O(h).
  scheme.symmetric = is_odd_in_h(member.c);
  scheme.order = vanishes_with_h(member.c) ? 2 : 1;
  scheme.source = "Jimenez-Perez, Vilotte, Romanowicz, 2015";
  if (member.c.empty()) {
    scheme.name = "implicit-midpoint";
  } else if (is_diagonal_gauge(member, Expression(0))) {
    scheme.name = "symplectic-euler-a";
  } else if (is_diagonal_gauge(member, Expression(1))) {
    scheme.name = "symplectic-euler-b";
  } else {
    scheme.name = "member";
  }
  scheme.method = std::move(member);
  return scheme;
}

}  // namespace

std::string to_text(const GaugeBlock& block, std::size_t columns) {
  std::string text;
  for (std::size_t k = 0; k < block.entries.size(); ++k) {
    if (k != 0) text += block.is_matrix && k % columns == 0 ? "], [" : ", ";
    text += block.words.empty() ? to_text(block.entries[k]) : block.words[k];
  }
  return block.is_matrix ? "[[" + text + "]]" : text;
}

Scheme family_member(int n, const GaugeBlock& alpha, const GaugeBlock& beta,
                     const GaugeBlock& gamma) {
  const Expression half(Rational(1, 2));
  const SparseMatrix beta_block = block_matrix("beta", beta, n);
  const SparseMatrix gamma_block = block_matrix("gamma", gamma, n);
  require_symmetric("beta", beta_block);
  require_symmetric("gamma", gamma_block);
  SparseMatrix a = block_matrix("alpha", alpha, n);
  for (int i = 0; i < n; ++i) {
    Expression& diagonal = a[{i, i}];
    diagonal = diagonal - half;
  }
  SparseMatrix c;
  for (const auto& [place, value] : a) {
    if (value.is_zero()) continue;
    c.emplace(place, value);
    c.emplace(std::pair(n + place.second, n + place.first), -value);
  }
  for (const auto& [place, value] : gamma_block) {
    c.emplace(std::pair(place.first, n + place.second), -value);
  }
  for (const auto& [place, value] : beta_block) {
    c.emplace(std::pair(n + place.first, place.second), -value);
  }
  Scheme scheme = member_scheme(n, std::move(c));
  const auto columns = static_cast<std::size_t>(n);
  scheme.description = fmt::format("alpha = {}, beta = {}, gamma = {}", to_text(alpha, columns),
                                   to_text(beta, columns), to_text(gamma, columns));
  return scheme;
}

std::vector<Scheme> named_members() {
  const std::string family = "Jimenez-Perez, Vilotte, Romanowicz 2015";
  auto member = [](Scheme scheme, const Expression& alpha) {
    scheme.method = family_member(1, {{alpha}}, {{0}}, {{0}}).method;
    return scheme;
  };
  return {
      member({.name = "implicit-midpoint",
              .description = "zbar = (z + Z)/2",
              .order = 2,
              .symmetric = true,
              .source = "Hairer, Lubich, Wanner, Geometric Numerical Integration (HLW), II.1.5"},
             Expression(Rational(1, 2))),
      member({.name = "symplectic-euler-a",
              .description = "H at (q, P); explicit for separable H",
              .source = family + "; HLW I.1.2"},
             Expression(0)),
      member({.name = "symplectic-euler-b",
              .description = "H at (Q, p); explicit for separable H",
              .source = family + "; HLW I.1.2"},
             Expression(1))};
}

Scheme member_of_matrix(int degrees_of_freedom, SparseMatrix c) {
  std::erase_if(c, [](const auto& place) { return place.second.is_zero(); });
  Scheme scheme = member_scheme(degrees_of_freedom, std::move(c));
  scheme.symplectic = std::ranges::all_of(
      gauge_defect(scheme.member()), [](const auto& place) { return looks_zero(place.second); });
  return scheme;
}

SparseMatrix gauge_defect(const Member& member) {
  const int n = member.degrees_of_freedom;
  // (C J)_ij = -C_{i,n+j} for j < n, C_{i,j-n} else; J C^T is its mirror image with the sign
  // turned.
  SparseMatrix defect;
  for (const auto& [place, value] : member.c) {
    const auto [row, column] = place;
    const int target = column < n ? column + n : column - n;
    const Expression signed_value = column < n ? value : -value;
    Expression& cj = defect[{row, target}];
    cj = cj + signed_value;
    Expression& jct = defect[{target, row}];
    jct = jct - signed_value;
  }
  std::erase_if(defect, [](const auto& place) { return vanishes(place.second); });
  return defect;
}

std::optional<FamilyParameters> uniform_parameters(const Member& member) {
  const int n = member.degrees_of_freedom;
  FamilyParameters first{.alpha = Expression(Rational(1, 2))};
  if (n == 0) return first;
  first.alpha = first.alpha + entry(member.c, 0, 0);
  first.beta = -entry(member.c, n, 0);
  first.gamma = -entry(member.c, 0, n);
  std::size_t entries = 0;
  for (int i = 0; i < n; ++i) {
    if (entry(member.c, i, i) != entry(member.c, 0, 0) ||
        entry(member.c, n + i, n + i) != -entry(member.c, 0, 0) ||
        entry(member.c, n + i, i) != entry(member.c, n, 0) ||
        entry(member.c, i, n + i) != entry(member.c, 0, n)) {
      return std::nullopt;
    }
    for (const auto& place : {std::pair(i, i), {n + i, n + i}, {n + i, i}, {i, n + i}}) {
      entries += member.c.contains(place) ? 1 : 0;
    }
  }
  if (entries != member.c.size()) return std::nullopt;
  return first;
}

Member of_all(const Member& member, int n) {
  if (member.degrees_of_freedom != 1) return member;
  Member all = member;
  all.degrees_of_freedom = n;
  all.c.clear();
  for (const auto& [place, entry] : member.c) {
    for (int i = 0; i < n; ++i)
      all.c.emplace(std::pair(place.first * n + i, place.second * n + i), entry);
  }
  return all;
}

bool has_beta(const Member& member) {
  const int n = member.degrees_of_freedom;
  for (const auto& [place, value] : member.c) {
    if (place.first >= n && place.second < n) return true;
  }
  return false;
}

bool has_gamma(const Member& member) {
  const int n = member.degrees_of_freedom;
  for (const auto& [place, value] : member.c) {
    if (place.first < n && place.second >= n) return true;
  }
  return false;
}

std::optional<Expression> at_zero_step(const Expression& entry) {
  if (!depends_on(entry, "h")) return entry;
  const std::optional<std::vector<Expression>> series = step_series(entry, 1);
  return series ? std::optional(series->front()) : std::nullopt;
}

std::vector<double> singular_steps(const Scheme& scheme) {
  if (!scheme.has_member()) return {};
  const std::vector<double>& steps = scheme.member().singular_steps;
  const auto* composition = std::get_if<Composition>(&scheme.method);
  if (composition == nullptr) return steps;
  std::set<double> result;
  for (const Expression& substep : composition->substeps) {
    const double part = std::abs(to_double(evaluate(substep, {}).value()));
    for (const double step : steps) result.insert(step / part);
  }
  return {result.begin(), result.end()};
}

SparseMatrix stage_matrix(const Member& member) {
  const int n = member.degrees_of_freedom;
  SparseMatrix i_plus_c = member.c;
  for (int i = 0; i < 2 * n; ++i) {
    Expression& diagonal = i_plus_c[{i, i}];
    diagonal = diagonal + Expression(Rational(1, 2));
  }
  // J = [[0, I], [-I, 0]]: column j of (..) J is -column n + j, column n + j is column j.
  SparseMatrix result;
  for (const auto& [place, value] : i_plus_c) {
    if (value.is_zero()) continue;
    const auto [row, column] = place;
    if (column < n) {
      result[{row, n + column}] = value;
    } else {
      result[{row, column - n}] = -value;
    }
  }
  return result;
}

}  // namespace hamgen
