// Immutable expressions in one canonical order: what every stage after the mechanics computes with.
//
// Equal mathematics built in any order gives the same tree: operands are sorted by structure and by
// the declared rank of their symbols, numeric factors are collected, and a sum whose leading term
// is negative is written as -(sum), so that a - b and b - a share one node.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "generator/algebra/exact.hpp"

namespace hamgen {

enum class Kind : std::uint8_t { number, symbol, power, function, product, sum };

class Expression {
 public:
  Expression();                // 0
  Expression(long value);      // NOLINT: numbers are expressions
  Expression(Rational value);  // NOLINT

  // Symbols are ordered by rank, then by name.  "pi" is the circle's number.
  [[nodiscard]] static Expression symbol(std::string name, int rank = 0);
  // A function of the table applied to its arguments.
  [[nodiscard]] static Expression apply(std::string function, std::vector<Expression> arguments);
  [[nodiscard]] static Expression sum(std::vector<Expression> terms);
  [[nodiscard]] static Expression product(std::vector<Expression> factors);
  [[nodiscard]] static Expression power(const Expression& base, const Expression& exponent);

  [[nodiscard]] Kind kind() const;
  [[nodiscard]] bool is_number() const { return kind() == Kind::number; }
  [[nodiscard]] bool is_zero() const;
  [[nodiscard]] bool is_one() const;
  [[nodiscard]] const Rational& number() const;   // of a number
  [[nodiscard]] const std::string& name() const;  // of a symbol or a function
  [[nodiscard]] int rank() const;                 // of a symbol
  // Terms, factors, {base, exponent} or arguments.
  [[nodiscard]] std::span<const Expression> operands() const;
  [[nodiscard]] std::size_t hash() const;
  // The node's address: equal expressions have one node.
  [[nodiscard]] const void* identity() const { return node_.get(); }

  // The numeric factor, and what is left without it: 3*x*y = {3, x*y}.
  [[nodiscard]] std::pair<Rational, Expression> split_coefficient() const;

  friend bool operator==(const Expression& a, const Expression& b);
  // A total order that depends on structure and declared ranks only.
  friend std::strong_ordering operator<=>(const Expression& a, const Expression& b);

  friend Expression operator+(const Expression& a, const Expression& b);
  friend Expression operator-(const Expression& a, const Expression& b);
  friend Expression operator*(const Expression& a, const Expression& b);
  friend Expression operator/(const Expression& a, const Expression& b);
  friend Expression operator-(const Expression& a);
  Expression& operator+=(const Expression& b) { return *this = *this + b; }

 private:
  struct Node;
  class Pool;
  explicit Expression(std::shared_ptr<const Node> node) : node_(std::move(node)) {}
  [[nodiscard]] static Expression make(Kind kind, Rational number, std::string name, int rank,
                                       std::vector<Expression> operands);
  std::shared_ptr<const Node> node_;
};

struct ExpressionHash {
  std::size_t operator()(const Expression& e) const { return e.hash(); }
};
template <class T>
using ExpressionMap = std::unordered_map<Expression, T, ExpressionHash>;

// Every symbol of the expression, by name.
[[nodiscard]] std::set<std::string> symbols(const Expression& e);
void collect_symbols(const Expression& e, std::set<std::string>& names);
[[nodiscard]] bool depends_on(const Expression& e, const std::string& symbol);
// Those below a function, a root or a reciprocal: of these e is not written as a polynomial.  Only
// in the others do vanishing derivatives prove it affine or quadratic; abs(x)'' = 0, and yet abs(x)
// is not affine.
[[nodiscard]] std::set<std::string> non_polynomial_symbols(const Expression& e);

// The expression with symbols replaced by expressions, all at once.
using Substitution = std::map<std::string, Expression>;
[[nodiscard]] Expression substitute(const Expression& e, const Substitution& replacements);
[[nodiscard]] std::vector<Expression> substitute(std::span<const Expression> values,
                                                 const Substitution& replacements);

// The same operation of other operands; e itself if it has none.
[[nodiscard]] Expression with_operands(const Expression& e, std::vector<Expression> operands);

[[nodiscard]] Expression square_root(const Expression& e);

// An expression of numbers and roots as a number, to 90 digits; an internal error for any other.
[[nodiscard]] Rational numeric_value(const Expression& e);

// The language's own notation with the fewest parentheses: "p^2/2 - eps*cos(q)".
[[nodiscard]] std::string to_text(const Expression& e);

}  // namespace hamgen
