#include "generator/verify/rational_step.hpp"

#include <algorithm>
#include <set>

#include "generator/algebra/evaluate.hpp"
#include "generator/algebra/from_ginac.hpp"
#include "generator/mechanics/generating_series.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

namespace {

constexpr unsigned long kBitsOfIrrational = 128;

Rational to_bits(const Rational& value) {
  Integer scaled = value.get_num() << kBitsOfIrrational;
  mpz_fdiv_q(scaled.get_mpz_t(), scaled.get_mpz_t(), value.get_den_mpz_t());
  Rational result(scaled, Integer(1) << kBitsOfIrrational);
  result.canonicalize();
  return result;
}

bool has_functions(const Expression& e) {
  if (e.kind() == Kind::function || (e.kind() == Kind::symbol && e.name() == "pi")) return true;
  if (e.kind() == Kind::power &&
      !(e.operands()[1].is_number() && e.operands()[1].number().get_den() == 1))
    return true;
  return std::ranges::any_of(e.operands(), has_functions);
}

RationalPolynomial polynomial_in(const GiNaC::ex& e, const GiNaC::ex& h) {
  RationalPolynomial result;
  const GiNaC::ex expanded = e.expand();
  for (int k = 0; k <= expanded.degree(h); ++k)
    result.push_back(to_rational(GiNaC::ex_to<GiNaC::numeric>(expanded.coeff(h, k))));
  return trimmed(std::move(result));
}

}  // namespace

bool is_short(const Rational& value) {
  // Powers of ten are no digits: 9.109e-31 is as short as 9.109.
  const auto bits = [](Integer x) {
    for (const unsigned long prime : {2UL, 5UL}) {
      const Integer factor = prime;
      mpz_remove(x.get_mpz_t(), x.get_mpz_t(), factor.get_mpz_t());
    }
    return mpz_sizeinbase(x.get_mpz_t(), 2);
  };
  // What is computed with them has all their bits.
  constexpr std::size_t kMostBits = 400;
  const std::size_t whole =
      mpz_sizeinbase(value.get_num_mpz_t(), 2) + mpz_sizeinbase(value.get_den_mpz_t(), 2);
  if (whole > kMostBits) return false;
  return sgn(value) == 0 || bits(value.get_num()) + bits(value.get_den()) <= 150;
}

ExactMatrix linear_flow(const ExactMatrix& s) {
  const std::size_t n = s.size / 2;
  ExactMatrix a = ExactMatrix::zero(s.size);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < s.size; ++j) {
      a(i, j) = s(n + i, j);
      a(n + i, j) = -s(i, j);
    }
  }
  return a;
}

RationalStep::RationalStep(const Scheme& scheme, std::map<std::string, Rational> values)
    : values_(std::move(values)) {
  if (const auto* splitting = std::get_if<Splitting>(&scheme.method)) {
    std::size_t kick = 0;
    std::size_t drift = 0;
    const auto& [kick_first, kicks, drifts] = *splitting;
    for (bool now = kick_first; kick < kicks.size() || drift < drifts.size(); now = !now) {
      if (now && kick < kicks.size()) shears_.emplace_back(true, number(kicks[kick++]));
      if (!now && drift < drifts.size()) shears_.emplace_back(false, number(drifts[drift++]));
    }
  } else if (const auto* tableau = std::get_if<RungeKutta>(&scheme.method)) {
    for (std::size_t i = 0; i < tableau->b.size(); ++i) {
      b_.push_back(number(tableau->b[i]));
      auto& row = a_.emplace_back();
      for (const Expression& e : tableau->a[i]) row.push_back(number(e));
    }
  } else {
    if (const auto* composition = std::get_if<Composition>(&scheme.method)) {
      substeps_.clear();
      for (const Expression& e : composition->substeps) substeps_.push_back(number(e));
    }
    read_gauge(scheme.member());
  }
}

Rational RationalStep::number(const Expression& e) {
  if (e.is_number() && is_short(e.number())) return e.number();
  exact_ = false;
  return to_bits(numeric_value(e));
}

void RationalStep::read_gauge(const Member& member) {
  order_ = member.generating_order;
  Substitution fixed;
  for (const auto& [name, value] : values_) fixed.emplace(name, Expression(value));
  std::set<std::string> used;
  c_.emplace();
  SymbolTable table;
  const GiNaC::ex h = table.symbol("h", kRankOfStep);
  GiNaC::ex denominator = 1;
  std::vector<GiNaC::ex> entries;
  for (const auto& [place, entry] : member.c) {
    collect_symbols(entry, used);
    c_->emplace(place, substitute(entry, fixed));
    if (has_functions(c_->at(place))) gauge_degree_.reset();
    if (!gauge_degree_) continue;
    entries.push_back(to_ginac(c_->at(place), table).normal());
    denominator = GiNaC::lcm(denominator, entries.back().denom());
  }
  for (const std::string& name : used) {
    const auto value = values_.find(name);
    if (value != values_.end() && !is_short(value->second)) exact_ = false;
  }
  if (order_ > 0) series_ = gauge_series(*c_, order_);
  if (!gauge_degree_) {
    exact_ = false;
    return;
  }
  common_denominator_ = polynomial_in(denominator, h);
  for (const GiNaC::ex& entry : entries)
    gauge_degree_ =
        std::max(*gauge_degree_, degree(polynomial_in((entry * denominator).normal(), h)));
}

std::optional<ExactMatrix> RationalStep::gauge(const Rational& h, std::size_t size) const {
  ExactMatrix result = ExactMatrix::zero(size);
  for (const auto& [place, entry] : *c_) {
    const std::optional<Rational> value = evaluate(entry, {{"h", h}});
    if (!value) return std::nullopt;
    result(static_cast<std::size_t>(place.first), static_cast<std::size_t>(place.second)) = *value;
  }
  return result;
}

// As LinearStep::increment: X D = E - I, D = (I/2 + C) E + I/2 - C, cut off after h^order.
ExactMatrix RationalStep::increment(const Rational& h, const ExactMatrix& a) const {
  if (order_ <= 0) return h * a;
  const auto order = static_cast<std::size_t>(order_);
  std::vector<ExactMatrix> c;
  for (const SparseMatrix& term : series_) {
    ExactMatrix& matrix = c.emplace_back(ExactMatrix::zero(a.size));
    for (const auto& [place, entry] : term) {
      matrix(static_cast<std::size_t>(place.first), static_cast<std::size_t>(place.second)) =
          evaluate(entry, {}).value_or(Rational(0));
    }
  }
  std::vector<ExactMatrix> flow{ExactMatrix::identity(a.size)};
  std::vector<ExactMatrix> divisor{flow[0]};
  std::vector<ExactMatrix> x{ExactMatrix::zero(a.size)};
  ExactMatrix sum = x[0];
  Rational power = 1;
  for (std::size_t k = 1; k <= order; ++k) {
    flow.push_back(Rational(1, static_cast<unsigned long>(k)) * (flow.back() * a));
    ExactMatrix d = Rational(1, 2) * flow[k];
    for (std::size_t l = 0; l < k; ++l) d = d + c[l] * flow[k - l];
    ExactMatrix term = flow[k];
    for (std::size_t l = 1; l < k; ++l) term = term - x[l] * divisor[k - l];
    divisor.push_back(std::move(d));
    power *= h;
    sum = sum + power * term;
    x.push_back(std::move(term));
  }
  return sum;
}

std::optional<RationalStep::Pencil> RationalStep::pencil(const Rational& h,
                                                         const ExactMatrix& s) const {
  const auto c = gauge(h, s.size);
  if (!c) return std::nullopt;
  const ExactMatrix x = increment(h, linear_flow(s));
  const ExactMatrix one = ExactMatrix::identity(s.size);
  const ExactMatrix half = Rational(1, 2) * one;
  return Pencil{one - x * (half + *c), one + x * (half - *c)};
}

ExactMatrix RationalStep::splitting_matrix(const Rational& h, const ExactMatrix& s) const {
  const std::size_t n = s.size / 2;
  ExactMatrix result = ExactMatrix::identity(s.size);
  for (const auto& [is_kick, length] : shears_) {
    ExactMatrix shear = ExactMatrix::identity(s.size);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        if (is_kick) {
          shear(n + i, j) = -length * h * s(i, j);
        } else {
          shear(i, n + j) = length * h * s(n + i, n + j);
        }
      }
    }
    result = shear * result;
  }
  return result;
}

// Z_i = z + h A sum a_ij Z_j, one after the other.
ExactMatrix RationalStep::explicit_matrix(const Rational& h, const ExactMatrix& s) const {
  const ExactMatrix ha = h * linear_flow(s);
  std::vector<ExactMatrix> slopes;
  ExactMatrix result = ExactMatrix::identity(s.size);
  for (std::size_t i = 0; i < b_.size(); ++i) {
    ExactMatrix stage = ExactMatrix::identity(s.size);
    for (std::size_t j = 0; j < i; ++j) stage = stage + a_[i][j] * slopes[j];
    slopes.push_back(ha * stage);
    result = result + b_[i] * slopes.back();
  }
  return result;
}

ExactMatrix RationalStep::matrix(const Rational& h, const ExactMatrix& s) const {
  if (!b_.empty()) return explicit_matrix(h, s);
  if (!c_) return splitting_matrix(h, s);
  ExactMatrix result = ExactMatrix::identity(s.size);
  for (const Rational& part : substeps_) {
    const auto now = pencil(part * h, s);
    if (!now) return {};
    const ExactMatrix one = solved(now->plus, now->minus);
    if (one.size == 0) return {};
    result = one * result;
  }
  return result;
}

// Minors of a product are sums of products of minors; those of A+^-1 are minors of A+ over det A+.
Rational RationalStep::denominator(const Rational& h, const ExactMatrix& s) const {
  Rational product = 1;
  if (!c_) return product;
  for (const Rational& part : substeps_) {
    const auto now = pencil(part * h, s);
    if (!now) return 0;
    const Rational c = value_at(common_denominator_, part * h);
    product *= determinant(c * now->plus);
  }
  return product;
}

std::optional<int> RationalStep::degree_in_h(std::size_t size) const {
  const int unknowns = static_cast<int>(size);
  if (!b_.empty()) return unknowns * static_cast<int>(b_.size());
  if (!c_) return unknowns / 2 * static_cast<int>(shears_.size());
  if (!gauge_degree_) return std::nullopt;
  const int own = std::max(*gauge_degree_, degree(common_denominator_)) + std::max(order_, 1);
  return unknowns * own * static_cast<int>(substeps_.size());
}

}  // namespace hamgen
