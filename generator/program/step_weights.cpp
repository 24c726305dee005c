#include "generator/program/step_weights.hpp"

#include <algorithm>
#include <array>

#include "generator/equations/step_equations.hpp"
#include "generator/program/arithmetic.hpp"
#include "generator/program/linear_terms.hpp"

namespace hamgen {

namespace {

Expression weight(const std::string& name) {
  return Expression::symbol("k." + name, kRankOfVariable - 1);
}

}  // namespace

StepWeights::StepWeights(const FamilyParameters& parameters) : member(parameters) {
  const Expression h = step_size();
  const auto named = [&](const Expression& value, const std::string& name,
                         const std::string& remark) -> std::optional<Expression> {
    if (value.is_zero()) return {};
    if (value.is_one()) return h;
    const bool half = value == Expression(Rational(1, 2));
    const std::string field = half ? "half_h" : name;
    if (std::ranges::find(coefficients, field, &NamedWeight::name) == coefficients.end()) {
      coefficients.push_back({field, h * value, half ? "h/2" : remark});
    }
    return weight(field);
  };
  const Expression rest = Expression(1) - member.alpha;
  const auto is_exact = [](const Expression& e) {
    return e.is_zero() || e.is_one() || e == Expression(Rational(1, 2));
  };
  if (is_exact(member.alpha)) {
    q_by_p = named(member.alpha, "", "");
    p_by_q = named(rest, "", "");
  } else {
    shares = true;
    q_takes_more = !member.alpha.is_number() || member.alpha.number() > Rational(1, 2);
    coefficients.push_back(
        {"share", q_takes_more ? member.alpha : rest, "alpha or 1 - alpha, the larger one"});
    const Expression more = h * weight("share");
    q_by_p = q_takes_more ? more : h - more;
    p_by_q = q_takes_more ? h - more : more;
  }
  p_by_p = named(member.beta, "h_beta", "h beta");
  q_by_q = named(member.gamma, "h_gamma", "h gamma");
}

void StepWeights::split_flow() {
  splits_flow_ = true;
  const Expression high = weight("h_high");
  const Expression low = weight("h_low");
  coefficients.push_back({"h_high", kHighPart * step_size(), "most of h, and no simple fraction"});
  coefficients.push_back({"h_low", step_size() - high, "what is left"});
  if (q_by_p == step_size()) return;
  const Expression half(Rational(1, 2));
  coefficients.push_back({"half_high", half * high, "their halves"});
  coefficients.push_back({"half_low", half * low, ""});
}

std::pair<Expression, Expression> StepWeights::flow_in_two_parts(const Expression& slope) {
  return {weight("h_high") * slope, weight("h_low") * slope};
}

bool StepWeights::uses_h() const {
  return std::ranges::any_of(std::array{q_by_p, p_by_q, p_by_p, q_by_q},
                             [](const auto& w) { return w && depends_on(*w, "h"); });
}

void StepWeights::bind(Routine& routine) const {
  for (const NamedWeight& c : coefficients) routine.places["k." + c.name] = {"k", c.name};
}

void StepWeights::add_product(RoutineBuilder& b, Body& body, StageRow& row, const std::string& name,
                              const Expression& sign, const Expression& weight,
                              const Expression& slope, bool exactly) {
  const auto names = [&](TermRole role, const Expression& value) {
    const bool is_lost = role == TermRole::product_error;
    return b.let(body, is_lost ? name + "_lost" : exactly ? name + "_rounded" : name, value);
  };
  const RoundedTerm term = rounded_product(names, weight, slope, exactly);
  row.large.push_back(sign * term.large);
  row.small += sign * term.small;
}

void StepWeights::add_share(RoutineBuilder& b, Body& body, StageRow& row, bool is_q,
                            const Expression& slope, bool exactly) const {
  const auto& by = is_q ? q_by_p : p_by_q;
  if (!by) return;
  const std::string stem = is_q ? "q_" : "p_";
  const Expression sign(is_q ? 1 : -1);
  if (!shares) {
    add_product(b, body, row, stem + "push", sign, *by, slope, exactly);
    return;
  }
  const RoundedTerm flow = flow_of(b, body, is_q, slope);
  const Expression share = weight("share");
  const bool is_left = is_q != q_takes_more;
  const auto names = [&](TermRole role, const Expression& value) {
    const char* of = role == TermRole::product ? "part" : role == TermRole::rest ? "left" : "lost";
    return b.let(body, stem + of, value);
  };
  const Expression shared = share * flow.small;
  const Expression small = is_left ? flow.small - shared : shared;
  const RoundedTerm term = rounded_share(names, share, flow.large, small, is_left);
  row.large.push_back(sign * term.large);
  row.small += sign * term.small;
}

RoundedTerm StepWeights::flow_of(RoutineBuilder& b, Body& body, bool is_q,
                                 const Expression& slope) {
  const std::string stem = is_q ? "q_" : "p_";
  const auto names = [&](TermRole role, const Expression& value) {
    return b.let(body, stem + (role == TermRole::product ? "flow" : "flow_lost"), value);
  };
  return rounded_product(names, step_size(), slope);
}

StageRow StepWeights::row_of_q(RoutineBuilder& b, Body& body, const Gradient& at,
                               bool exactly) const {
  StageRow row;
  bind(b.routine());
  add_share(b, body, row, true, at.by_p, exactly);
  if (q_by_q) add_product(b, body, row, "q_turn", Expression(1), *q_by_q, at.by_q, exactly);
  return row;
}

StageRow StepWeights::row_of_q_in_parts(RoutineBuilder& b, Body& body, const Gradient& at) const {
  StageRow row;
  bind(b.routine());
  const bool whole = q_by_p == step_size();
  row.large.push_back(b.let(body, "q_push", weight(whole ? "h_high" : "half_high") * at.by_p));
  row.small = weight(whole ? "h_low" : "half_low") * at.by_p;
  if (q_by_q) add_product(b, body, row, "q_turn", Expression(1), *q_by_q, at.by_q, false);
  return row;
}

StageRow StepWeights::row_of_p(RoutineBuilder& b, Body& body, const Gradient& at,
                               bool exactly) const {
  StageRow row;
  bind(b.routine());
  add_share(b, body, row, false, at.by_q, exactly);
  if (p_by_p) add_product(b, body, row, "p_turn", Expression(-1), *p_by_p, at.by_p, exactly);
  return row;
}

}  // namespace hamgen
