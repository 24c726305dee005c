// The rows of a step's equations: what a stage is, and what it lacks of that.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "generator/program/arithmetic.hpp"
#include "generator/program/step_builder.hpp"

namespace hamgen {

Expression StepBuilder::row(int i, int section) {
  std::vector<Expression> terms{carry_symbol(i)};
  std::vector<Expression> small = terms;
  for (const int k : equations_.row_gradients(i)) {
    const auto [large, lost] = row_terms(i, k, gradient_[index(k)], section);
    terms.push_back(large);
    small.push_back(lost);
  }
  if (keeps_gradients_ || splits_products_) {
    terms[0] = named_rest("beside " + name_of(i), Expression::sum(std::move(small)), section);
  }
  return equations_.mechanics.variable(i) +
         named_rest(name_of(i), Expression::sum(std::move(terms)), section);
}

Expression StepBuilder::weight(int i, int k) const {
  return step_size() * equations_.stage_matrix.at({i, k});
}

Expression StepBuilder::lacking(int i, const Expression& value, int section) {
  // The largest weights first.  The last of these differences cancels and has no error, and of a
  // small step none has.
  std::vector<int> components = equations_.row_gradients(i);
  std::ranges::stable_sort(components, std::greater<>(), [&](int k) {
    const Expression& entry = equations_.stage_matrix.at({i, k});
    return entry.is_number() ? Rational(abs(entry.number())) : Rational(1, 4);
  });
  std::vector<Expression> small{carry_symbol(i)};
  Expression difference = value;
  const auto subtract = [&](const Expression& part, bool cancels) {
    const int before = rests_["gap " + name_of(i)]++;
    const std::string name =
        name_of(i) + " gap" + (before > 0 ? fmt::format(" {}", before) : std::string());
    const Expression left = name_value(name, difference - part, section);
    if (solves_constants_ && !cancels) {
      const Expression lost = Expression::apply(kDifferenceError, {difference, part});
      small.push_back(-name_value(name + " error", lost, section));
    }
    difference = left;
  };
  subtract(equations_.mechanics.variable(i), components.empty());
  for (const int k : components) {
    const auto [large, lost] = row_terms(i, k, gradient_[index(k)], section);
    subtract(large, k == components.back());
    small.push_back(lost);
  }
  return difference -
         named_rest("beside " + name_of(i), Expression::sum(std::move(small)), section);
}

std::pair<Expression, Expression> StepBuilder::row_terms(int i, int k, const Expression& gradient,
                                                         int section) {
  const Expression entry = equations_.stage_matrix.at({i, k});
  // Of an iteration before this one, from its rounded end to the solution.
  const auto change = change_of_gradient_.find(k);
  const Expression later = change == change_of_gradient_.end() ? Expression(0) : change->second;
  if (!keeps_gradients_) {
    const Parts h = step_size_for(k);
    return {h.high * entry * gradient, h.low * entry * gradient + weight(i, k) * later};
  }
  const std::string& of = gradient.name();
  const auto [flow, lost_of_flow] = flow_of(k, gradient, section);
  const Expression flow_lost = lost_of_flow + step_size() * later;
  if (multiplies_exactly(entry)) return {entry * flow, entry * flow_lost};
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
  const std::string text = short_name(to_text(factor) + "*" + of, name_of(i) + " " + of);
  const Expression part =
      name_once("part(" + text + ")", factor * flow, section, Lowering::Keep::apart);
  const Expression lost =
      name_once("lost(" + text + ")", Expression::apply(kProductError, {factor, flow}), section);
  if (!is_left) return {sign * part, sign * lost + entry * flow_lost};
  const Expression left = name_once("left(" + text + ")", flow - part, section);
  return {sign * left, -(sign * lost) + entry * flow_lost};
}

// The product's own text, or of a long one, whose first place names it, that place.
std::string StepBuilder::short_name(const std::string& text, const std::string& place) {
  constexpr std::size_t longest = 40;
  return text.size() <= longest ? text : short_names_.try_emplace(text, place).first->second;
}

std::pair<Expression, Expression> StepBuilder::flow_of(int k, const Expression& gradient,
                                                       int section) {
  const std::string text = "h*" + gradient.name();
  const Expression flow = name_once(text, step_size() * gradient, section, Lowering::Keep::apart);
  if (!keeps_losses_ || !is_of_state(k)) return {flow, Expression(0)};
  Expression lost = name_once("lost(" + text + ")",
                              Expression::apply(kProductError, {step_size(), gradient}), section);
  const auto of_gradient = lost_of_gradient_.find(gradient.name());
  if (of_gradient != lost_of_gradient_.end()) {
    lost =
        name_once("lost(" + text + ") in all", lost + step_size() * of_gradient->second, section);
  }
  return {flow, lost};
}

// Where its factors are constant: the components of the stage that it is a sum of products with.
std::optional<StepBuilder::ConstantFactors> StepBuilder::constant_factors(int k) const {
  if (!solves_constants_ || !keeps_losses_ || !equations_.has_exact_hessian()) return {};
  ConstantFactors result;
  for (int v = 0; v < 2 * n_; ++v) {
    if (!equations_.is_polynomial(k, v)) return {};
    const Expression factor = equations_.stage_hessian(k, v);
    if (depends_on_state(factor)) return {};
    if (!factor.is_zero()) result.factors.emplace_back(v, factor);
  }
  Substitution zero;
  for (int v = 0; v < 2 * n_; ++v) zero.emplace(equations_.stage(v).name(), Expression(0));
  result.at_zero = substitute(equations_.stage_gradient(k), zero);
  return result;
}

Expression StepBuilder::constant(const Expression& factor) {
  if (factor.is_number()) return factor;
  return name_once("(" + to_text(factor) + ")", factor, kCoefficients);
}

// One product is the very one whose loss is told: the same constant, made of the parameters in
// another way, may be rounded otherwise.
Expression StepBuilder::value_of_gradient(int k, int section) {
  const std::optional<ConstantFactors> sum = constant_factors(k);
  if (!sum || sum->factors.size() != 1 || !sum->at_zero.is_zero()) {
    const Expression& value = equations_.stage_gradient(k);
    return at_stage(splits_products_ ? with_split_products(value, section) : value);
  }
  const auto& [v, factor] = sum->factors.front();
  return constant(factor) * stage_value_[index(v)];
}

// It is the sum of the products of constants with the stage: what is left of it when they are
// subtracted, and what products and differences lose.
void StepBuilder::find_lost_of_gradient(int k, int section) {
  const std::optional<ConstantFactors> sum = constant_factors(k);
  if (!sum) return;
  const Expression gradient = gradient_[index(k)];
  std::vector<Expression> parts;
  std::vector<Expression> small;
  if (!sum->at_zero.is_zero()) {
    const std::string name = "(" + to_text(sum->at_zero) + ")";
    parts.push_back(name_once(name, sum->at_zero, kCoefficients));
  }
  for (const auto& [v, factor] : sum->factors) {
    const Expression& value = stage_value_[index(v)];
    const std::string text =
        short_name(to_text(factor) + "*" + value.name(), gradient.name() + " " + value.name());
    const Expression number = constant(factor);
    parts.push_back(
        name_once("part(" + text + ")", number * value, section, Lowering::Keep::apart));
    if (!multiplies_exactly(factor)) {
      small.push_back(name_once("lost(" + text + ")",
                                Expression::apply(kProductError, {number, value}), section));
    }
  }
  // The last difference cancels and has no error.
  Expression left = gradient;
  for (std::size_t j = 0; parts.size() > 1 && j < parts.size(); ++j) {
    const Expression difference = named_rest("left " + gradient.name(), left - parts[j], section);
    if (j + 1 < parts.size()) {
      const Expression lost = Expression::apply(kDifferenceError, {left, parts[j]});
      small.push_back(-name_value("lost" + difference.name().substr(4), lost, section));
    } else {
      small.push_back(-difference);
    }
    left = difference;
  }
  if (small.empty()) return;
  lost_of_gradient_[gradient.name()] =
      name_once("lost(" + gradient.name() + ")", Expression::sum(std::move(small)), section);
}

bool StepBuilder::is_of_state(int k) const {
  return depends_on_state(equations_.stage_gradient(k));
}

bool StepBuilder::depends_on_state(const Expression& e) const {
  const std::set<std::string> used = symbols(e);
  for (int v = 0; v < 2 * n_; ++v) {
    if (used.contains(equations_.stage(v).name())) return true;
  }
  return false;
}

}  // namespace hamgen
