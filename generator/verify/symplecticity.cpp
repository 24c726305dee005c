#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "generator/algebra/from_ginac.hpp"
#include "generator/mechanics/step_series.hpp"
#include "generator/verify/identities.hpp"
#include "generator/verify/proof.hpp"
#include "generator/verify/sums_of_step.hpp"

namespace hamgen {

namespace {

Expression entry(const SparseMatrix& matrix, int i, int j) {
  const auto it = matrix.find({i, j});
  return it == matrix.end() ? Expression(0) : it->second;
}

GiNaC::matrix canonical_j(unsigned n) {
  GiNaC::matrix j(2 * n, 2 * n);
  for (unsigned i = 0; i < n; ++i) {
    j(i, n + i) = 1;
    j(n + i, i) = -1;
  }
  return j;
}

}  // namespace

Finding prove_gauge(const Member& member, const Surroundings& around) {
  std::optional<Decision> at_points;
  for (const auto& [place, value] : gauge_defect(member)) {
    // Expanding shows no zero; points may.
    const Decision decision = decide_equal("`C J + J C^T`", value, Expression(0), around);
    if (decision.verdict == Verdict::tested) at_points = decision;
    if (holds(decision.verdict)) continue;
    return {kGauge, decision.verdict,
            fmt::format("entry ({}, {}) of `C J + J C^T` is `{}`", place.first + 1,
                        place.second + 1, to_text(value))};
  }
  if (at_points) return {kGauge, Verdict::tested, "`C J + J C^T = 0` " + points_text(*at_points)};
  return {kGauge, Verdict::proved, "`C J + J C^T = 0`, entry by entry"};
}

Finding prove_step_symplectic(const Member& of, int n, const Surroundings& around) {
  const int m = std::min(n, 3);
  const Member member = of_all(of, m);
  const auto size = static_cast<unsigned>(2 * m);
  SymbolTable table;
  const GiNaC::ex h = table.symbol("h", 0);
  // The generic symmetric S and the gauge of the first m degrees of freedom.
  GiNaC::matrix s(size, size);
  GiNaC::matrix c(size, size);
  SumsOfStep sums;
  const GiNaC::ex half = GiNaC::numeric(1, 2);
  auto place = [&](unsigned i) {
    const int k = static_cast<int>(i);
    return k < m ? k : member.degrees_of_freedom - m + k;
  };
  for (unsigned i = 0; i < size; ++i) {
    for (unsigned j = 0; j < size; ++j) {
      s(i, j) = table.symbol(fmt::format("S{}_{}", std::min(i, j) + 1, std::max(i, j) + 1), 0);
      c(i, j) = to_ginac(sums.named(entry(member.c, place(i), place(j))), table);
    }
  }
  const GiNaC::matrix j = canonical_j(static_cast<unsigned>(m));
  GiNaC::matrix one(size, size);
  for (unsigned i = 0; i < size; ++i) one(i, i) = 1;
  const GiNaC::matrix js = j.mul(s).mul_scalar(h);
  const GiNaC::matrix plus = one.sub(js.mul(one.mul_scalar(half).add(c)));
  const GiNaC::matrix minus = one.add(js.mul(one.mul_scalar(half).sub(c)));
  const GiNaC::matrix left = plus.mul(j).mul(plus.transpose());
  const GiNaC::matrix right = minus.mul(j).mul(minus.transpose());
  std::optional<Decision> at_points;
  for (unsigned row = 0; row < size; ++row) {
    for (unsigned column = 0; column < size; ++column) {
      const GiNaC::ex difference = (left(row, column) - right(row, column)).expand();
      if (difference.is_zero()) continue;
      const Expression entry = sums.written_out(from_ginac(difference, table));
      const Decision decision = decide_equal("`A+ J A+^T`", entry, Expression(0), around);
      if (decision.verdict == Verdict::tested) at_points = decision;
      if (holds(decision.verdict)) continue;
      return {"symplectic", decision.verdict,
              fmt::format("entry ({}, {}) of `A+ J A+^T - A- J A-^T` is {}", row + 1, column + 1,
                          to_text(entry))};
    }
  }
  if (at_points && m == n) {
    return {"symplectic", Verdict::tested,
            fmt::format("`A+ J A+^T = A- J A-^T` {}; for exactly solved steps",
                        points_text(*at_points))};
  }
  if (m == n) {
    return {
        "symplectic", Verdict::proved,
        fmt::format("`A+ J A+^T = A- J A-^T` for every symmetric Hessian, all {} entries expand "
                    "to zero; for exactly solved steps",
                    size * size)};
  }
  const Finding gauge = prove_gauge(member, around);
  return {
      "symplectic", gauge.verdict,
      fmt::format("`A+ J A+^T - A- J A-^T = -h^2 J S (C J + J C^T) S J`, and {}; checked entry by "
                  "entry on the first {} of {} degrees of freedom",
                  gauge.detail, m, n)};
}

Finding prove_symmetric(const Member& member, const Surroundings& around) {
  std::optional<Decision> at_points;
  for (const auto& [place, value] : member.c) {
    const Expression reflected = substitute(value, {{"h", -Expression::symbol("h", kRankOfStep)}});
    if (vanishes(reflected + value)) continue;
    // What points take for zero may be a number that is not.
    const Decision decision = (reflected + value).is_number()
                                  ? Decision{.verdict = Verdict::refuted}
                                  : decide_equal("`C(-h)`", reflected, -value, around);
    if (decision.verdict == Verdict::tested) at_points = decision;
    if (holds(decision.verdict)) continue;
    return {
        "symmetric", decision.verdict,
        fmt::format("`C(-h) + C(h)` has the entry `({}, {}) = {}`; the adjoint is the member `-C`",
                    place.first + 1, place.second + 1, to_text(reflected + value))};
  }
  if (at_points)
    return {"symmetric", Verdict::tested, "`C(-h) = -C(h)` " + points_text(*at_points)};
  return {"symmetric", Verdict::proved, "`C(-h) = -C(h)`: the step is its own adjoint"};
}

// With f = J grad H and C = C0 + h C1 + O(h^2), the step minus the flow is
//   h^2 f'(C0 f) + h^3 ( f'(C1 f) - f''(f, f)/24 + f'(f'(f))/12 + terms in C0 ) + O(h^4):
// zbar = z + h (1/2 + C) f + ..., Z = z + h f(zbar), against the flow's h^2/2 f'f + h^3/6 (...).
Finding prove_order(const Member& member, const Surroundings& around) {
  std::optional<Decision> at_points;
  for (const auto& [place, value] : member.c) {
    const auto series = step_series(value, 2);
    if (!series) {
      return {"order", Verdict::not_decided,
              fmt::format("no power series in `h` was found for the entry ({}, {}) of `C`, `{}`",
                          place.first + 1, place.second + 1, to_text(value))};
    }
    const Expression& at_zero = series->front();
    const Decision decision = decide_equal("`C(0)`", at_zero, Expression(0), around);
    if (decision.verdict == Verdict::tested) at_points = decision;
    if (holds(decision.verdict)) continue;
    if (decision.verdict == Verdict::not_decided)
      return {"order", decision.verdict, decision.witness};
    return {"order 1", Verdict::proved,
            fmt::format(
                "leading error `h^2 f'(C0 f)`, `f = J grad H`; `C0` has the entry `({}, {}) = {}`",
                place.first + 1, place.second + 1, to_text(at_zero))};
  }
  return {
      "order 2", at_points ? Verdict::tested : Verdict::proved,
      fmt::format("`C(0) = 0`{}; leading error `h^3 (f'(C1 f) - f''(f,f)/24 + f'(f'(f))/12)`, `f = "
                  "J grad H`",
                  at_points ? " " + points_text(*at_points) : "")};
}

Finding prove_raised_order(const GeneratingFunction& function, const Decision& of_k) {
  const std::string property = fmt::format("order {}", function.order);
  if (!holds(of_k.verdict)) return {property, of_k.verdict, of_k.witness};
  return {
      property, of_k.verdict,
      fmt::format("`K` is from the Hamilton-Jacobi equation of the generating function, to `h^{}`; "
                  "the flow of `H` satisfies its step to `h^{}` at {} points to `1e-30`",
                  function.order - 1, function.order, of_k.points)};
}

}  // namespace hamgen
