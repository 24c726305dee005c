#include "generator/program/linear_terms.hpp"

#include <algorithm>

namespace hamgen {

bool is_power_of_two(const Expression& factor) {
  const auto is_power = [](const mpz_class& n) { return mpz_popcount(n.get_mpz_t()) == 1; };
  if (!factor.is_number() || factor.is_zero()) return false;
  const Rational magnitude = abs(factor.number());
  return is_power(magnitude.get_num()) && is_power(magnitude.get_den());
}

Parts in_two_parts(const Expression& constant, const Define& define) {
  const std::string name = "(" + to_text(constant) + ")";
  const Expression high = define("high" + name, kHighPart * constant, true);
  return {high, define("low" + name, constant - high, false)};
}

bool LinearTerms::is_constant(const Expression& e) const {
  return std::ranges::none_of(symbols(e), [&](const auto& name) { return state_.contains(name); });
}

bool LinearTerms::is_sum(const Expression& e) const {
  const auto is_multiple = [&](const Expression& term) {
    const auto [number, value] = term.split_coefficient();
    return is_power_of_two(Expression(number)) && value.kind() == Kind::symbol &&
           state_.contains(value.name());
  };
  const auto [number, rest] = e.split_coefficient();
  if (rest.kind() != Kind::sum) return is_multiple(e);
  return is_power_of_two(Expression(number)) && std::ranges::all_of(rest.operands(), is_multiple);
}

LinearTerms::Product LinearTerms::product(const Expression& e) const {
  if (is_sum(e)) return {Expression(1), e, true};
  if (e.kind() != Kind::product) return {};
  std::vector<Expression> constants;
  std::vector<Expression> others;
  for (const Expression& factor : e.operands()) {
    (is_constant(factor) ? constants : others).push_back(factor);
  }
  if (others.size() != 1) return {};
  return {Expression::product(std::move(constants)), others[0], is_sum(others[0])};
}

bool LinearTerms::are_in(const Expression& e) const {
  const auto in = [&](const Expression& term) { return are_in(term); };
  if (e.kind() == Kind::sum && !is_sum(e)) return std::ranges::any_of(e.operands(), in);
  const Product found = product(e);
  return found.is_linear || (found.factor.kind() == Kind::sum && in(found.factor));
}

Expression LinearTerms::split(const Expression& e, const Definitions& definitions) const {
  std::vector<Expression> large;
  std::vector<Expression> small;
  const auto add = [&](const Expression& term) {
    const Parts parts = split_term(term, definitions);
    large.push_back(parts.high);
    if (!parts.low.is_zero()) small.push_back(parts.low);
  };
  if (e.kind() == Kind::sum && !is_sum(e)) {
    std::ranges::for_each(e.operands(), add);
  } else {
    add(e);
  }
  if (small.size() > 1) small = {definitions.of_small_parts(Expression::sum(std::move(small)))};
  large.insert(large.end(), small.begin(), small.end());
  return Expression::sum(std::move(large));
}

Parts LinearTerms::split_term(const Expression& term, const Definitions& definitions) const {
  const Product found = product(term);
  if (!found.is_linear) {
    if (found.factor.kind() != Kind::sum) return {term, Expression(0)};
    return {found.constant * split(found.factor, definitions), Expression(0)};
  }
  const auto [number, symbol] = found.constant.split_coefficient();
  const Expression factor{is_power_of_two(Expression(number)) ? number : Rational(1)};
  const Expression constant = factor.is_one() ? found.constant : symbol;
  if (is_power_of_two(constant)) return {term, Expression(0)};
  const Expression x = definitions.at_stage(found.factor);
  const auto [high, low] = definitions.in_two_parts(constant);
  return {factor * (high * x), factor * (low * x)};
}

bool LinearTerms::may_be_all_of(const Expression& e) const {
  const auto may = [&](const Expression& term) { return may_be_all_of(term); };
  if (e.kind() == Kind::sum && !is_sum(e)) return std::ranges::all_of(e.operands(), may);
  const Product found = product(e);
  if (found.is_linear || is_constant(e)) return true;
  if (found.factor.kind() == Kind::sum && may(found.factor)) return true;
  // With a symbol among its factors that is none of the state.
  return e.kind() == Kind::product && std::ranges::any_of(e.operands(), [&](const auto& factor) {
           return is_constant(factor) && !factor.is_number();
         });
}

bool has_linear_forces(const Mechanics& mechanics) {
  std::set<std::string> names;
  if (!mechanics.keeps_sums()) {
    const int n = mechanics.degrees_of_freedom;
    for (int i = 0; i < 2 * n; ++i) names.insert(mechanics.variable(i).name());
    const LinearTerms terms(std::move(names));
    return std::any_of(mechanics.gradient.begin(), mechanics.gradient.begin() + n,
                       [&](const Expression& force) { return terms.are_in(force); });
  }
  for (const Kernel& kernel : mechanics.kernels) {
    for (const Slot& slot : kernel.slots) names.insert(slot.symbol);
  }
  const LinearTerms terms(std::move(names));
  return std::ranges::any_of(mechanics.kernels, [&](const Kernel& kernel) {
    for (std::size_t i = 0; i < kernel.slots.size(); ++i) {
      if (!kernel.slots[i].is_momentum && terms.are_in(kernel.gradient[i])) return true;
    }
    return false;
  });
}

}  // namespace hamgen
