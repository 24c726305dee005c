// The rows of a step's equations: what a stage is, and what it lacks of that.
#include <algorithm>
#include <functional>

#include "generator/program/arithmetic.hpp"
#include "generator/program/step_builder.hpp"

namespace hamgen {

bool StepBuilder::is_exact_weight(const Expression& e) {
  return e.is_one() || e == Expression(Rational(1, 2)) || e == Expression(-1) ||
         e == Expression(Rational(-1, 2));
}

Expression StepBuilder::row(int i, int section) {
  return row_of(i, section, [&](int k) { return row_terms(i, k, gradient_[index(k)], section); });
}

// Note [a stage moves by what the step moves by]
// h times the rounded sum of a gradient and its correction is another number than both of them
// times h, by which z moves: for h = 0.3 and alpha = 3/10 the form of a chain drifts by 8e-4 units
// of rounding a step.
Expression StepBuilder::row_at_solution(int i, int section) {
  return row_of(i, section, [&](int k) {
    const auto& [main, change] = correction_[index(k)];
    if (change.is_zero()) return row_terms(i, k, gradient_[index(k)], section);
    auto [large, lost] = row_terms(i, k, main, section);
    return std::pair(large, lost + weight(i, k) * change);
  });
}

template <class TermsOf>
Expression StepBuilder::row_of(int i, int section, const TermsOf& terms_of) {
  std::vector<Expression> terms{carry_symbol(i)};
  std::vector<Expression> small = terms;
  bool has_small = keeps_gradients_;
  for (const int k : equations_.row_gradients(i)) {
    const auto [large, lost] = terms_of(k);
    terms.push_back(large);
    small.push_back(lost);
    has_small = has_small || !lost.is_zero();
  }
  if (has_small) {
    terms[0] = named_rest("beside " + name_of(i), Expression::sum(std::move(small)), section);
  }
  return equations_.mechanics.variable(i) +
         named_rest(name_of(i), Expression::sum(std::move(terms)), section);
}

Expression StepBuilder::weight(int i, int k) const {
  return step_size() * equations_.stage_matrix.at({i, k});
}

Expression StepBuilder::lacking(int i, const Expression& value, int section) {
  if (!keeps_gradients_) return value - row(i, section);
  // The largest weights first: these differences cancel, and have no error.
  std::vector<int> components = equations_.row_gradients(i);
  std::ranges::stable_sort(components, std::greater<>(), [&](int k) {
    const Expression& entry = equations_.stage_matrix.at({i, k});
    return entry.is_number() ? Rational(abs(entry.number())) : Rational(1, 4);
  });
  Expression difference =
      named_rest("lack " + name_of(i), value - equations_.mechanics.variable(i), section);
  std::vector<Expression> small{carry_symbol(i)};
  for (const int k : components) {
    const auto [large, lost] = row_terms(i, k, gradient_[index(k)], section);
    difference = named_rest("lack " + name_of(i), difference - large, section);
    small.push_back(lost);
  }
  return difference -
         named_rest("beside " + name_of(i), Expression::sum(std::move(small)), section);
}

std::pair<Expression, Expression> StepBuilder::row_terms(int i, int k, const Expression& gradient,
                                                         int section) {
  const Expression entry = equations_.stage_matrix.at({i, k});
  if (!keeps_gradients_) return {weight(i, k) * gradient, Expression(0)};
  const std::string& of = gradient.name();
  const auto [flow, flow_lost] = flow_of(k, gradient, section);
  if (is_exact_weight(entry)) return {entry * flow, entry * flow_lost};
  // The larger of two weights that sum to one is multiplied, the smaller is what is left.
  const Expression sign(i < n_ ? 1 : -1);
  const bool diagonal = k == (i < n_ ? i + n_ : i - n_);
  const Expression own = sign * entry;
  const Expression other = Expression(1) - own;
  const bool is_smaller = own.is_number() ? own.number() < Rational(1, 2) : i >= n_;
  const bool is_left = diagonal && is_smaller;
  Expression factor = is_left ? other : own;
  if (!factor.is_number()) {
    factor = name_once("(" + to_text(factor) + ")", factor, kCoefficients);
  }
  const std::string text = to_text(factor) + "*" + of;
  const Expression part =
      name_once("part(" + text + ")", factor * flow, section, Lowering::Keep::apart);
  const Expression lost =
      name_once("lost(" + text + ")", Expression::apply(kProductError, {factor, flow}), section);
  if (!is_left) return {sign * part, sign * lost + entry * flow_lost};
  const Expression left = name_once("left(" + text + ")", flow - part, section);
  return {sign * left, -(sign * lost) + entry * flow_lost};
}

std::pair<Expression, Expression> StepBuilder::flow_of(int k, const Expression& gradient,
                                                       int section) {
  const std::string text = "h*" + gradient.name();
  const Expression flow = name_once(text, step_size() * gradient, section, Lowering::Keep::apart);
  if (!keeps_losses_ || !is_of_state(k)) return {flow, Expression(0)};
  return {flow, name_once("lost(" + text + ")",
                          Expression::apply(kProductError, {step_size(), gradient}), section)};
}

bool StepBuilder::is_of_state(int k) const {
  const std::set<std::string> used = symbols(equations_.stage_gradient(k));
  for (int v = 0; v < 2 * n_; ++v) {
    if (used.contains(equations_.stage(v).name())) return true;
  }
  return false;
}

}  // namespace hamgen
