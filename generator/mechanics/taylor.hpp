// Power series in one small quantity, carried through an expression.
#pragma once

#include <functional>
#include <map>
#include <utility>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// Replaces the symbols x of expressions by series x + x_1 h + x_2 h^2 + ... and gives the
// coefficients of the results, each computed once: all of them to h^k cost O(k^2) operations a
// node.
class TaylorSeries {
 public:
  // x_k, k >= 1, of the symbol; zero for a symbol that stays as it is.
  using Input = std::function<Expression(const Expression& symbol, int k)>;
  explicit TaylorSeries(Input input) : input_(std::move(input)) {}

  // The coefficient of h^k, as an expression in the symbols.
  [[nodiscard]] Expression coefficient(const Expression& e, int k);

 private:
  [[nodiscard]] Expression compute(const Expression& e, int k);
  [[nodiscard]] Expression product(const Expression& a, const Expression& b, int k);
  [[nodiscard]] Expression power(const Expression& e, int k);

  Input input_;
  std::map<std::pair<const void*, int>, Expression> known_;
  std::vector<Expression> keep_alive_;  // their addresses are keys
};

}  // namespace hamgen
