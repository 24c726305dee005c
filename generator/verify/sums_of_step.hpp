// Long sums of functions of h alone, as symbols: the gauge of a linear part, which every equation
// has and none takes apart.  What vanishes for any value of theirs vanishes.
#pragma once

#include <cstddef>
#include <map>

#include "generator/algebra/expression.hpp"

namespace hamgen {

class SumsOfStep {
 public:
  // The expression with a symbol for each of its sums, the same one for equal sums.
  [[nodiscard]] Expression named(const Expression& e);
  // With the sums for the symbols again.
  [[nodiscard]] Expression written_out(const Expression& e) const;
  [[nodiscard]] bool empty() const { return meaning_.empty(); }

 private:
  enum class Of { numbers, step, others };
  struct Facts {
    std::size_t size;  // as a tree, up to what is long
    Of symbols;
  };

  [[nodiscard]] Facts facts(const Expression& e);
  [[nodiscard]] bool is_one(const Expression& e);

  std::map<const void*, Facts> facts_;
  ExpressionMap<Expression> known_;
  Substitution meaning_;
};

}  // namespace hamgen
