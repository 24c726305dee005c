// Terms c x of a gradient: constants times sums of the state.  See Note [constants in two parts] in
// program/step_builder.hpp.
#pragma once

#include <functional>
#include <set>
#include <string>

#include "generator/algebra/expression.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

// Is it one of floating-point numbers, whose products have no error?
[[nodiscard]] bool is_power_of_two(const Expression& factor);

// Most of a constant, as a part of it: no simple fraction, and so near to 1 that what products with
// the rest lose, a ten-thousandth of a rounding error, counts for nothing.  Of the sum of both
// products the smaller one says how the larger one is rounded: a pattern that over the numbers
// between two powers of two turns 1700 times in the 24 digits of float.  A millionth, with which it
// turned 16 times, was a drift of 3e-3 units there.
inline const Expression kHighPart{Rational(9999, 10000)};

// A constant is the sum of them, exactly: high is within a factor 2 of it, so the difference that
// low is has no error (Sterbenz).
struct Parts {
  Expression high;
  Expression low;
};
// Gives a value its name, once, and returns the symbol; `apart`: even a number that the algebra
// could put in its place.
using Define =
    std::function<Expression(const std::string& name, const Expression& value, bool apart)>;
[[nodiscard]] Parts in_two_parts(const Expression& constant, const Define& define);
// Is it the name that `high` was given?
[[nodiscard]] inline bool is_high_part(const std::string& name) {
  return name.starts_with("high(");
}

class LinearTerms {
 public:
  // Of expressions whose symbols of the state are these.
  explicit LinearTerms(std::set<std::string> state) : state_(std::move(state)) {}

  // Is it a sum of symbols of the state, or of their doubles or halves?  It is on their grid then.
  [[nodiscard]] bool is_sum(const Expression& e) const;
  // {c, x} of c x with a constant c and such a sum x, {1, x} of x alone; of any other product of
  // a constant with one factor that factor alone, and nothing of anything else.
  struct Product {
    Expression constant = {};
    Expression factor = {};
    bool is_linear = false;
  };
  [[nodiscard]] Product product(const Expression& e) const;
  // Has it a term c x?
  [[nodiscard]] bool are_in(const Expression& e) const;
  // e with both products of c x, c in two parts, where products with c have errors.  Those of the
  // small parts are a sum of their own, which gets a name: see Note [the sum of the small parts].
  struct Definitions {
    std::function<Parts(const Expression& constant)> in_two_parts;
    std::function<Expression(const Expression& sum)> at_stage;
    std::function<Expression(const Expression& sum)> of_small_parts;
  };
  [[nodiscard]] Expression split(const Expression& e, const Definitions& definitions) const;
  // Is it a sum of such terms and constants alone, or of others that a parameter may take away?
  [[nodiscard]] bool may_be_all_of(const Expression& e) const;

 private:
  [[nodiscard]] bool is_constant(const Expression& e) const;
  [[nodiscard]] Parts split_term(const Expression& term, const Definitions& definitions) const;
  std::set<std::string> state_;
};

// Has a force of H such a term?
[[nodiscard]] bool has_linear_forces(const Mechanics& mechanics);

}  // namespace hamgen
