// Words to expression trees.
#pragma once

#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/language/ast.hpp"
#include "generator/language/token.hpp"

namespace hamgen {

inline constexpr int deepest_nesting = 200;
// No tree is higher than this, so that walking or destroying it needs a bounded stack.  A flat sum
// of n terms is a tree of height n.
inline constexpr int highest_tree = 2000;

// Ends the statement being parsed; empty if the mistake is reported already.
struct SyntaxError {
  std::optional<Diagnostic> diagnostic;
};

// Reads from a list of tokens that ends with `newline`, `end`.
class ExpressionParser {
 public:
  explicit ExpressionParser(const std::vector<Token>& tokens) : tokens_(tokens) {}

  [[nodiscard]] const Token& peek(std::size_t ahead = 0) const;
  [[nodiscard]] const Token& previous() const { return tokens_[at_ > 0 ? at_ - 1 : 0]; }
  const Token& next();
  bool accept(std::string_view symbol);
  [[nodiscard]] bool at_line_end() const;
  // A last word `rising` or `falling`: of an event, behind its expression.
  [[nodiscard]] bool at_direction() const;
  // How often a token was looked at: the work so far.
  [[nodiscard]] std::size_t looks() const { return looks_; }

  // sum := product (('+' | '-') product)*
  NodePtr expression();
  // Throws unless the token at hand can end an expression.
  void expect_operator_or_end();

  // Throws the mistake; a token that is `bad` has been reported and stays silent.
  [[noreturn]] void fail(Span span, std::string message, std::string help = {}) const;
  // "expected WHAT after '+'", or "expected WHAT, found ')'".
  [[noreturn]] void expected(std::string_view what, std::string help = {}) const;

 private:
  struct Tree {
    NodePtr node;
    Span span;  // with the parentheses around it
    int height = 1;
  };
  class Nesting;

  Tree sum();
  Tree product();
  Tree unary();
  Tree power();
  Tree exponent();
  Tree primary();
  Tree parenthesised();
  Tree name();
  Tree call(const Token& function);
  Tree indexed_sum(const Token& keyword);
  SumRange sum_range(int& height);
  Tree number();
  Tree binary(BinaryOperator operation, const Tree& left, const Tree& right) const;
  void close(std::string_view closer, const Token& opener);
  void missing_operator() const;
  void reject_non_operator() const;

  const std::vector<Token>& tokens_;
  std::size_t at_ = 0;
  int depth_ = 0;
  mutable std::size_t looks_ = 0;
};

}  // namespace hamgen
