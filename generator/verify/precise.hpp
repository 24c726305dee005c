// Expressions evaluated with 60 digits: what is compared where algebra alone does not decide.
#pragma once

#include <cln/float.h>
#include <cln/real.h>

#include <map>
#include <optional>
#include <random>
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

// A number from 1/4 to 7/4, the same in every process.
[[nodiscard]] Precise random_precise(std::mt19937_64& source);

// The values of expressions at one point: of free symbols, and of definitions computed when they
// are first asked for.  Empty where an expression is not defined or not real.
class PreciseValues {
 public:
  PreciseValues(std::map<std::string, Precise> free, const Substitution& definitions)
      : values_(std::move(free)), definitions_(definitions) {}
  [[nodiscard]] std::optional<Precise> operator()(const Expression& e);

 private:
  // Throws std::domain_error outside the domain.
  [[nodiscard]] Precise value(const Expression& e);
  [[nodiscard]] Precise symbol(const std::string& name);

  std::map<std::string, Precise> values_;
  const Substitution& definitions_;
  std::map<const void*, std::pair<Expression, Precise>> done_;  // by node, which is kept alive
};

}  // namespace hamgen
