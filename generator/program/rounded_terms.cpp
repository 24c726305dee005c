#include "generator/program/rounded_terms.hpp"

#include "generator/program/arithmetic.hpp"

namespace hamgen {

RoundedTerm rounded_product(const NameInTerm& name, const Expression& weight, const Expression& x,
                            bool with_error) {
  RoundedTerm term{name(TermRole::product, weight * x)};
  if (with_error) {
    term.small = name(TermRole::product_error, Expression::apply(kProductError, {weight, x}));
  }
  return term;
}

RoundedTerm rounded_share(const NameInTerm& name, const Expression& share, const Expression& x,
                          const Expression& small, bool is_left) {
  const RoundedTerm product = rounded_product(name, share, x);
  if (!is_left) return {product.large, product.small + small};
  return {name(TermRole::rest, x - product.large), small - product.small};
}

RoundedTerm rounded_difference(const NameInTerm& name, const Expression& x,
                               const std::vector<Expression>& numbers, Errors errors) {
  RoundedTerm term{x};
  for (std::size_t j = 0; j < numbers.size(); ++j) {
    const bool is_last = j + 1 == numbers.size();
    const Expression before = term.large;
    term.large = name(TermRole::difference, before - numbers[j]);
    if (errors == Errors::none || (is_last && errors == Errors::of_all_but_the_last)) continue;
    const Expression error = Expression::apply(kDifferenceError, {before, numbers[j]});
    term.small += name(TermRole::difference_error, error);
  }
  return term;
}

}  // namespace hamgen
