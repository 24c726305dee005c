// Expressions evaluated with 60 digits: what is compared where algebra alone does not decide.
#pragma once

#include <cln/float.h>
#include <cln/real.h>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// A real number of 60 digits.
using Precise = cln::cl_F;

[[nodiscard]] Precise precise(const Rational& value);
[[nodiscard]] double to_double(const Precise& value);

// The value of a function of the language, or of "pi" without arguments.  Throws std::domain_error
// where there is none.
[[nodiscard]] Precise precise_function(const std::string& name, const std::vector<Precise>& x);

// A value and the size of the terms it comes from: rounding has moved it by about `scale` times the
// unit of the last digit, to first order.  A zero is told from a small number by it.
struct ScaledValue {
  Precise value, scale;
};
// Is a value that is exactly zero likely to come out so?  40 of the 60 digits of its terms cancel.
[[nodiscard]] bool is_zero(const ScaledValue& x);
[[nodiscard]] ScaledValue operator-(const ScaledValue& a, const ScaledValue& b);

// The values of expressions at one point: of free symbols, and of definitions computed when they
// are first asked for.  Empty where an expression is not defined or not real.
class PreciseValues {
 public:
  PreciseValues(const std::map<std::string, Precise>& free, const Substitution& definitions);
  [[nodiscard]] std::optional<Precise> operator()(const Expression& e);
  [[nodiscard]] std::optional<ScaledValue> scaled(const Expression& e);
  // Was a value missing because its digits were not enough to tell it from a pole?
  [[nodiscard]] bool has_lost_digits() const { return lost_digits_; }

 private:
  // Throws std::domain_error outside the domain.
  [[nodiscard]] ScaledValue value(const Expression& e);
  [[nodiscard]] ScaledValue computed(const Expression& e);
  [[nodiscard]] ScaledValue symbol(const std::string& name);

  std::map<std::string, ScaledValue> values_;
  bool lost_digits_ = false;
  const Substitution& definitions_;
  std::map<const void*, std::pair<Expression, ScaledValue>> done_;  // by node, which is kept alive
};

// The value of a number that has no symbols.
[[nodiscard]] Precise value_of_exact(const Expression& e);

}  // namespace hamgen
