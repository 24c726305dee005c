#include <fmt/format.h>

#include "generator/base/diagnostic.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

namespace {

void check_count(const char* name, const std::vector<Expression>& values, int n) {
  if (values.size() == 1 || values.size() == static_cast<std::size_t>(n)) return;
  throw UsageError(fmt::format("--{} has {} values; give 1, or {}: one per degree of freedom", name,
                               values.size(), n));
}

const Expression& entry(const std::vector<Expression>& values, int i) {
  return values.size() == 1 ? values[0] : values[static_cast<std::size_t>(i)];
}

std::string list_text(const std::vector<Expression>& values) {
  std::string text;
  for (const Expression& value : values) text += (text.empty() ? "" : ", ") + to_text(value);
  return text;
}

// The expression with h replaced by -h.
Expression reflected(const Expression& e) {
  return substitute(e, {{"h", -Expression::symbol("h")}});
}

bool is_odd_in_h(const std::vector<Expression>& values) {
  for (const Expression& value : values) {
    if (!(reflected(value) + value).is_zero()) return false;
  }
  return true;
}

bool all_are(const std::vector<Expression>& values, const Expression& wanted) {
  for (const Expression& value : values) {
    if (value != wanted) return false;
  }
  return true;
}

bool vanishes_with_h(const std::vector<Expression>& values) {
  for (const Expression& value : values) {
    if (!substitute(value, {{"h", Expression(0)}}).is_zero()) return false;
  }
  return true;
}

}  // namespace

Scheme family_member(int n, std::vector<Expression> alpha, std::vector<Expression> beta,
                     std::vector<Expression> gamma) {
  check_count("alpha", alpha, n);
  check_count("beta", beta, n);
  check_count("gamma", gamma, n);
  Scheme scheme;
  Member member;
  member.degrees_of_freedom = n;
  const Expression half(Rational(1, 2));
  auto set = [&](int i, int j, const Expression& value) {
    if (!value.is_zero()) member.c.insert_or_assign({i, j}, value);
  };
  for (int i = 0; i < n; ++i) {
    set(i, i, entry(alpha, i) - half);
    set(i, n + i, -entry(gamma, i));
    set(n + i, i, -entry(beta, i));
    set(n + i, n + i, half - entry(alpha, i));
  }
  scheme.description = fmt::format("alpha = {}, beta = {}, gamma = {}", list_text(alpha),
                                   list_text(beta), list_text(gamma));
  const bool plain = all_are(beta, Expression(0)) && all_are(gamma, Expression(0));
  // Mathematics: the adjoint of C is -C, so C(-h) = -C(h) makes the member symmetric; order 2 needs
  // C = O(h).
  scheme.symmetric = all_are(alpha, half) && is_odd_in_h(beta) && is_odd_in_h(gamma);
  scheme.order = all_are(alpha, half) && vanishes_with_h(beta) && vanishes_with_h(gamma) ? 2 : 1;
  scheme.source = "Jimenez-Perez, Vilotte, Romanowicz, 2015";
  if (plain && all_are(alpha, half)) {
    scheme.name = "implicit-midpoint";
  } else if (plain && all_are(alpha, Expression(0))) {
    scheme.name = "symplectic-euler-a";
  } else if (plain && all_are(alpha, Expression(1))) {
    scheme.name = "symplectic-euler-b";
  } else {
    scheme.name = "member";
  }
  member.alpha = std::move(alpha);
  member.beta = std::move(beta);
  member.gamma = std::move(gamma);
  scheme.method = std::move(member);
  return scheme;
}

std::map<std::pair<int, int>, Expression> stage_matrix(const Member& member) {
  const int n = member.degrees_of_freedom;
  auto i_plus_c = member.c;
  for (int i = 0; i < 2 * n; ++i) {
    Expression& diagonal = i_plus_c[{i, i}];
    diagonal = diagonal + Expression(Rational(1, 2));
  }
  // J = [[0, I], [-I, 0]]: column j of (..) J is -column n + j, column n + j is column j.
  std::map<std::pair<int, int>, Expression> result;
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
