// Terms of a row with what rounding takes from them: the one place that says where it is told, for
// unknowns with names of their own and for elements of arrays alike.  How a value is named, and
// where it is computed, is the storage's.  See the notes in program/step_builder.hpp.
#pragma once

#include <functional>
#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// A number as it is rounded, and what it lacks of what it stands for.
struct RoundedTerm {
  Expression large;
  Expression small = Expression(0);
};

// What a value is in a term.
enum class TermRole {
  product,
  product_error,
  rest,  // of a number without a product
  difference,
  difference_error,
};

// Gives a value its name and returns the symbol.
using NameInTerm = std::function<Expression(TermRole, const Expression&)>;

// weight x, with its error or without.
[[nodiscard]] RoundedTerm rounded_product(const NameInTerm& name, const Expression& weight,
                                          const Expression& x, bool with_error = true);

// See Note [weights that sum to one] in program/step_builder.hpp: of share x and (1 - share) x,
// which is_left asks for, the larger is a product and the other what is left of x.  `small` is what
// belongs to it of what x lacks.
[[nodiscard]] RoundedTerm rounded_share(const NameInTerm& name, const Expression& share,
                                        const Expression& x, const Expression& small, bool is_left);

// Of which differences the errors are told.  Where numbers cancel, the last one has none.
enum class Errors { none, of_all, of_all_but_the_last };

// x less these numbers, one after the other.
[[nodiscard]] RoundedTerm rounded_difference(const NameInTerm& name, const Expression& x,
                                             const std::vector<Expression>& numbers, Errors errors);

}  // namespace hamgen
