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

void StepBuilder::find_rounded_beside() {
  Mechanics of_energy = equations_.mechanics;
  if (equations_.function) of_energy.gradient = equations_.energy_gradient;
  rounded_beside_ = rounded_beside(of_energy, [this](int i, int k) {
    return equations_.stage_matrix.contains({i, k}) ? weight(i, k) : Expression(0);
  });
}

void StepBuilder::begin_with_state(PendingSolve& pending, int x) {
  const Expression z = equations_.mechanics.variable(x);
  const Expression& length = rounded_beside_[index(x)];
  pending.cold.push_back(lowering_.want(z, before(stage_)));
  pending.beside.push_back(lowering_.want(z + length, before(stage_)));
}

Expression StepBuilder::lacking(int i, const Expression& value, int section) {
  // The largest weights first.  The last of these differences cancels and has no error, and of a
  // small step none has.
  std::vector<int> components = equations_.row_gradients(i);
  std::ranges::stable_sort(components, std::greater<>(), [&](int k) {
    const Expression& entry = equations_.stage_matrix.at({i, k});
    return entry.is_number() ? Rational(abs(entry.number())) : Rational(1, 4);
  });
  std::vector<Expression> numbers{equations_.mechanics.variable(i)};
  std::vector<Expression> small{carry_symbol(i)};
  for (const int k : components) {
    const RoundedTerm term = row_terms(i, k, gradient_[index(k)], section);
    numbers.push_back(term.large);
    small.push_back(term.small);
  }
  std::string gap;
  const auto names = [&](TermRole role, const Expression& number) {
    if (role == TermRole::difference) {
      const int before = rests_["gap " + name_of(i)]++;
      gap = name_of(i) + " gap" + (before > 0 ? fmt::format(" {}", before) : std::string());
    }
    return name_value(role == TermRole::difference ? gap : gap + " error", number, section);
  };
  const Errors errors = solves_constants_ ? Errors::of_all_but_the_last : Errors::none;
  const RoundedTerm difference = rounded_difference(names, value, numbers, errors);
  small.push_back(-difference.small);
  return difference.large -
         named_rest("beside " + name_of(i), Expression::sum(std::move(small)), section);
}

RoundedTerm StepBuilder::row_terms(int i, int k, const Expression& gradient, int section) {
  const Expression entry = equations_.stage_matrix.at({i, k});
  // Of an iteration before this one, from its rounded end to the solution.
  const auto change = change_of_gradient_.find(k);
  const Expression later = change == change_of_gradient_.end() ? Expression(0) : change->second;
  if (!keeps_gradients_) {
    const Parts h = step_size_for(k);
    return {h.high * entry * gradient, h.low * entry * gradient + weight(i, k) * later};
  }
  const std::string& of = gradient.name();
  RoundedTerm flow = flow_of(k, gradient, section);
  flow.small += step_size() * later;
  if (multiplies_exactly(entry)) return {entry * flow.large, entry * flow.small};
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
  const RoundedTerm term =
      rounded_share(name_of_product(text, section), factor, flow.large, own * flow.small, is_left);
  return {sign * term.large, sign * term.small};
}

NameInTerm StepBuilder::name_of_product(const std::string& text, int section) {
  return [this, text, section](TermRole role, const Expression& value) {
    if (role == TermRole::product)
      return name_once("part(" + text + ")", value, section, Lowering::Keep::apart);
    const char* what = role == TermRole::rest ? "left(" : "lost(";
    return name_once(what + text + ")", value, section);
  };
}

// The product's own text, or of a long one, whose first place names it, that place.
std::string StepBuilder::short_name(const std::string& text, const std::string& place) {
  constexpr std::size_t longest = 40;
  return text.size() <= longest ? text : short_names_.try_emplace(text, place).first->second;
}

RoundedTerm StepBuilder::flow_of(int k, const Expression& gradient, int section) {
  const std::string text = "h*" + gradient.name();
  const bool tells = keeps_losses_ && is_of_state(k);
  const auto names = [&](TermRole role, const Expression& value) {
    if (role == TermRole::product) return name_once(text, value, section, Lowering::Keep::apart);
    return name_once("lost(" + text + ")", value, section);
  };
  RoundedTerm flow = rounded_product(names, step_size(), gradient, tells);
  const auto of_gradient = lost_of_gradient_.find(gradient.name());
  if (tells && of_gradient != lost_of_gradient_.end()) {
    flow.small = name_once("lost(" + text + ") in all",
                           flow.small + step_size() * of_gradient->second, section);
  }
  return flow;
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
    return at_stage(splits_products_ ? gradient_in_parts(k, section)
                                     : equations_.stage_gradient(k));
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
    const RoundedTerm part = rounded_product(name_of_product(text, section), constant(factor),
                                             value, !multiplies_exactly(factor));
    parts.push_back(part.large);
    if (!part.small.is_zero()) small.push_back(part.small);
  }
  if (parts.size() > 1) {
    // The last difference cancels and has no error.
    std::string last;
    const auto names = [&](TermRole role, const Expression& number) {
      if (role == TermRole::difference_error) return name_value("lost" + last, number, section);
      const Expression difference = named_rest("left " + gradient.name(), number, section);
      last = difference.name().substr(4);
      return difference;
    };
    const RoundedTerm left =
        rounded_difference(names, gradient, parts, Errors::of_all_but_the_last);
    small.push_back(-left.small);
    small.push_back(-left.large);
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
