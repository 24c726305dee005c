#include "generator/language/expression_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "generator/algebra/functions.hpp"
#include "generator/base/utf8.hpp"
#include "generator/language/words.hpp"

namespace hamgen {
namespace {

std::string shown(std::string_view text) {
  return text.size() > 30 ? printable(text.substr(0, 30)) + "..." : printable(text);
}

std::string describe(const Token& token) {
  if (token.kind == TokenKind::newline || token.kind == TokenKind::end) return "the line ends";
  if (token.kind == TokenKind::unit) return fmt::format("found '[{}]'", shown(token.text));
  return fmt::format("found '{}'", shown(token.text));
}

bool is_comparison(const Token& token) {
  for (const std::string_view text : {"==", "<=", ">=", "!=", "~=", "<", ">", "!", "&&", "||"}) {
    if (is_symbol(token, text)) return true;
  }
  return false;
}

bool is_operator(const Token& token) {
  return token.kind == TokenKind::symbol &&
         token.text.find_first_not_of("+-*/^") == std::string_view::npos;
}

}  // namespace

// Counts what is open around the token at hand.
class ExpressionParser::Nesting {
 public:
  explicit Nesting(ExpressionParser& parser) : parser_(parser) {
    if (++parser_.depth_ <= deepest_nesting) return;
    const Span span = parser_.peek().span;
    --parser_.depth_;
    parser_.fail(span, fmt::format("nested deeper than {} levels", deepest_nesting),
                 "name inner parts with 'let'");
  }
  ~Nesting() { --parser_.depth_; }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;

 private:
  ExpressionParser& parser_;
};

const Token& ExpressionParser::peek(std::size_t ahead) const {
  ++looks_;
  return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
}

const Token& ExpressionParser::next() {
  const Token& token = peek();
  if (at_ + 1 < tokens_.size()) ++at_;
  return token;
}

bool ExpressionParser::accept(std::string_view symbol) {
  if (!is_symbol(peek(), symbol)) return false;
  next();
  return true;
}

bool ExpressionParser::at_line_end() const {
  return peek().kind == TokenKind::newline || peek().kind == TokenKind::end;
}

bool ExpressionParser::at_direction() const {
  const std::string_view word = peek().text;
  if (peek().kind != TokenKind::name || (word != "rising" && word != "falling")) return false;
  const TokenKind behind = peek(1).kind;
  return behind == TokenKind::newline || behind == TokenKind::end;
}

void ExpressionParser::fail(Span span, std::string message, std::string help) const {
  if (peek().kind == TokenKind::bad) throw SyntaxError{};
  throw SyntaxError{Diagnostic{Severity::error, span, std::move(message), std::move(help)}};
}

void ExpressionParser::expected(std::string_view what, std::string help) const {
  const Token& before = previous();
  if (at_line_end()) {
    fail(before.span, fmt::format("expected {} after '{}'", what, shown(before.text)),
         std::move(help));
  }
  fail(peek().span, fmt::format("expected {}, {}", what, describe(peek())), std::move(help));
}

NodePtr ExpressionParser::expression() { return sum().node; }

ExpressionParser::Tree ExpressionParser::binary(BinaryOperator operation, const Tree& left,
                                                const Tree& right) const {
  const Span span{left.span.begin, right.span.end};
  const int height = 1 + std::max(left.height, right.height);
  if (height > highest_tree) {
    fail(right.span, fmt::format("more than {} operations in one expression", highest_tree),
         "split it with 'let', or write it as sum(i = 1..N, ...)");
  }
  return {std::make_shared<const Node>(Node{span, BinaryNode{operation, left.node, right.node}}),
          span, height};
}

ExpressionParser::Tree ExpressionParser::sum() {
  Tree left = product();
  while (is_symbol(peek(), "+") || is_symbol(peek(), "-")) {
    const bool plus = next().text == "+";
    left = binary(plus ? BinaryOperator::add : BinaryOperator::subtract, left, product());
  }
  return left;
}

ExpressionParser::Tree ExpressionParser::product() {
  Tree left = unary();
  while (true) {
    if (is_symbol(peek(), "*") || is_symbol(peek(), "/")) {
      const bool times = next().text == "*";
      left = binary(times ? BinaryOperator::multiply : BinaryOperator::divide, left, unary());
    } else {
      missing_operator();
      return left;
    }
  }
}

// "2q", "q p", "2(q + 1)": two operands side by side.
void ExpressionParser::missing_operator() const {
  const Token& after = peek();
  if (at_direction()) return;
  const bool operand =
      after.kind == TokenKind::name || after.kind == TokenKind::number || is_symbol(after, "(");
  if (operand) {
    const Token& before = previous();
    const std::string left = shown(before.text);
    const std::string right = shown(after.text);
    const std::string open = find_function(after.text) != nullptr ? "(...)" : "";
    const bool group = right == "(" || left == ")";
    const bool goes_on = before.kind == TokenKind::number && after.kind == TokenKind::number &&
                         before.span.end == after.span.begin && right.starts_with('.');
    if (goes_on && left.find_first_of("eE") != std::string::npos) {
      fail({before.span.begin, after.span.end}, fmt::format("malformed number '{}{}'", left, right),
           "an exponent is an integer, as in 2.5e3");
    }
    if (after.kind == TokenKind::name && is_symbol(peek(1), "="))
      fail(after.span, "expected an operator or the end of the line",
           fmt::format("one formula a line: '{} = ...' begins a line of its own", right));
    fail({before.span.begin, after.span.end},
         fmt::format("missing operator between '{}' and '{}'", left, right),
         group ? "write '*' between them" : fmt::format("write {}*{}{}", left, right, open));
  }
  if (is_symbol(after, "**")) {
    fail(after.span, "'**' is not an operator", "write '^' for a power, as in q^2");
  }
}

// A sign binds less tightly than a power: -q^2 is -(q^2).
ExpressionParser::Tree ExpressionParser::unary() {
  if (!is_symbol(peek(), "-") && !is_symbol(peek(), "+")) return power();
  const Nesting nesting(*this);
  const Token& sign = next();
  Tree operand = unary();
  operand.span.begin = sign.span.begin;
  if (sign.text == "+") return operand;
  return {std::make_shared<const Node>(Node{operand.span, NegateNode{operand.node}}), operand.span,
          operand.height + 1};
}

// Powers are right-associative: 2^3^2 is 2^(3^2).
ExpressionParser::Tree ExpressionParser::power() {
  const Tree base = primary();
  if (!is_symbol(peek(), "^")) return base;
  const Nesting nesting(*this);
  next();
  return binary(BinaryOperator::power, base, exponent());
}

ExpressionParser::Tree ExpressionParser::exponent() {
  const bool sign = is_symbol(peek(), "-") || is_symbol(peek(), "+");
  return sign ? unary() : power();
}

ExpressionParser::Tree ExpressionParser::primary() {
  const Token& token = peek();
  if (token.kind == TokenKind::number) return number();
  if (token.kind == TokenKind::name) return name();
  if (is_symbol(token, "(")) return parenthesised();
  if (is_symbol(token, "{") || is_symbol(token, "[")) {
    fail(token.span, fmt::format("'{}' does not belong in an expression", token.text),
         "write parentheses: (q + p)");
  }
  if (is_symbol(token, "*") && is_operator(previous()) && previous().text == "*") {
    fail(token.span, "'* *' is not an operator", "write '^' for a power, as in q^2");
  }
  expected("an operand", "an operand is a number, a name, a function or a parenthesis");
}

ExpressionParser::Tree ExpressionParser::parenthesised() {
  const Nesting nesting(*this);
  const Token& opener = next();
  Tree inside = sum();
  close(")", opener);
  inside.span = {opener.span.begin, previous().span.end};
  return inside;
}

void ExpressionParser::close(std::string_view closer, const Token& opener) {
  if (accept(closer)) return;
  if (at_line_end() || is_symbol(peek(), "}") || is_symbol(peek(), ";")) {
    fail(opener.span, fmt::format("'{}' is never closed", opener.text),
         fmt::format("add '{}'", closer));
  }
  reject_non_operator();
  fail(peek().span, fmt::format("expected an operator or '{}', {}", closer, describe(peek())));
}

ExpressionParser::Tree ExpressionParser::number() {
  const Token& token = next();
  const std::optional<Rational> value = parse_decimal(token.text);
  const double rounded = value ? to_double(*value) : 0.0;
  const bool zero = token.text.substr(0, token.text.find_first_of("eE")).find_first_not_of("0.") ==
                    std::string_view::npos;
  if (!zero && (!value || rounded == 0.0 || !std::isfinite(rounded))) {
    fail(token.span,
         fmt::format("the number {} is outside the range of a double", shown(token.text)),
         "numbers lie between 4.9e-324 and 1.7e308; choose other units");
  }
  return {std::make_shared<const Node>(Node{token.span, NumberNode{zero ? Rational(0) : *value}}),
          token.span, 1};
}

ExpressionParser::Tree ExpressionParser::name() {
  const Token& token = next();
  if (token.text == "sum" && is_symbol(peek(), "(")) return indexed_sum(token);
  if (is_symbol(peek(), "(")) return call(token);
  if (find_function(token.text) != nullptr) {
    fail(token.span, fmt::format("the function '{}' has no argument", token.text),
         fmt::format("write {}(...)", token.text));
  }
  if (token.text == "sum") {
    fail(token.span, "'sum' without its range", "write sum(i = 1..N, ...)");
  }
  if (peek().kind == TokenKind::unit) {
    fail(peek().span, fmt::format("'[{}]' is read as a unit here", shown(peek().text)),
         fmt::format("write a subscript directly after its name: {}[{}]", token.text,
                     shown(peek().text)));
  }
  NodePtr subscript;
  int height = 1;
  Span span = token.span;
  if (is_symbol(peek(), "[")) {
    const Nesting nesting(*this);
    const Token& opener = next();
    const Tree inside = sum();
    if (is_symbol(peek(), ",")) {
      fail(peek().span, "a second subscript", "an array has one index; use two arrays");
    }
    close("]", opener);
    if (is_symbol(peek(), "[")) {
      fail(peek().span, "a second subscript", "an array has one index; use two arrays");
    }
    subscript = inside.node;
    height += inside.height;
    span.end = previous().span.end;
  }
  return {std::make_shared<const Node>(Node{span, NameNode{std::string(token.text), subscript}}),
          span, height};
}

ExpressionParser::Tree ExpressionParser::call(const Token& function) {
  const Nesting nesting(*this);
  const Token& opener = next();
  CallNode node{.function = std::string(function.text), .arguments = {}};
  int height = 1;
  if (!is_symbol(peek(), ")")) {
    do {
      const Tree argument = sum();
      node.arguments.push_back(argument.node);
      height = std::max(height, argument.height);
    } while (accept(","));
  }
  close(")", opener);
  const Span span{function.span.begin, previous().span.end};
  return {std::make_shared<const Node>(Node{span, std::move(node)}), span, height + 1};
}

// sum(i = 1..N, j = i+1..N, body)
ExpressionParser::Tree ExpressionParser::indexed_sum(const Token& keyword) {
  const Nesting nesting(*this);
  const Token& opener = next();
  SumNode node;
  int height = 1;
  while (peek().kind == TokenKind::name && is_symbol(peek(1), "=")) {
    node.ranges.push_back(sum_range(height));
    if (is_symbol(peek(), ")")) {
      fail({keyword.span.begin, peek().span.end}, "a sum without a body",
           "write sum(i = 1..N, ...) with the term to be added last");
    }
    if (!accept(",")) {
      if (at_line_end()) close(")", opener);
      expected("',' and the term to be added", "write sum(i = 1..N, ...)");
    }
  }
  if (node.ranges.empty()) {
    fail(keyword.span, "'sum' without its range", "write sum(i = 1..N, ...)");
  }
  if (node.ranges.size() > 8) fail(keyword.span, "a sum over more than 8 indices");
  const Tree body = sum();
  node.body = body.node;
  if (is_symbol(peek(), ",")) {
    fail(peek().span, "a sum has one body", "ranges come first: sum(i = 1..N, j = 1..N, ...)");
  }
  close(")", opener);
  const Span span{keyword.span.begin, previous().span.end};
  return {std::make_shared<const Node>(Node{span, std::move(node)}), span,
          std::max(height, body.height) + 1};
}

SumRange ExpressionParser::sum_range(int& height) {
  const Token& index = next();
  if (const std::string meaning = reserved_meaning(index.text); !meaning.empty()) {
    fail(index.span, fmt::format("'{}' is reserved: {}", index.text, meaning),
         "choose another index, such as i");
  }
  next();  // '='
  const Tree lower = sum();
  if (!accept("..")) expected("'..'", "a range is written i = 1..N");
  const Tree upper = sum();
  height = std::max({height, lower.height, upper.height});
  return {std::string(index.text), lower.node, upper.node,
          Span{index.span.begin, previous().span.end}};
}

void ExpressionParser::expect_operator_or_end() {
  const Token& token = peek();
  if (at_line_end()) return;
  if (is_symbol(token, ")") || is_symbol(token, "]")) {
    fail(token.span, fmt::format("'{}' closes nothing", token.text),
         "remove it, or write its opener");
  }
  reject_non_operator();
  const bool goes_on = is_symbol(token, ",") || is_symbol(token, ";");
  const bool is_in_digits = is_symbol(token, ",") && previous().kind == TokenKind::number &&
                            peek(1).kind == TokenKind::number &&
                            previous().span.end == token.span.begin &&
                            token.span.end == peek(1).span.begin;
  if (is_in_digits) {
    fail({previous().span.begin, peek(1).span.end}, "a comma in a number",
         fmt::format("write {}.{}: a number has a decimal point", shown(previous().text),
                     shown(peek(1).text)));
  }
  fail(token.span, fmt::format("expected an operator or the end of the line, {}", describe(token)),
       goes_on ? "one formula a line: what follows begins a line of its own"
               : "the terms of an expression are joined by + - * / ^");
}

// What can never go on an expression, wherever it stands.
void ExpressionParser::reject_non_operator() const {
  const Token& token = peek();
  if (is_symbol(token, "!=")) {
    fail(
        token.span, fmt::format("'{}' does not belong in an expression", token.text),
        "sum(i = 1..N, j = i+1..N, ...) takes every pair once, and none of an element with itself");
  }
  if (is_symbol(token, "=") || is_comparison(token)) {
    fail(token.span, fmt::format("'{}' does not belong in an expression", token.text),
         "an expression is one number, made with + - * / ^ and functions");
  }
  if (is_symbol(token, "..")) {
    const Token& after = peek(1);
    if (previous().kind == TokenKind::number && after.kind == TokenKind::number) {
      fail({previous().span.begin, after.span.end},
           fmt::format("malformed number '{}..{}'", previous().text, after.text),
           "a number has one point");
    }
    fail(token.span, "a range out of place",
         "ranges stand in declarations and in sum(i = 1..N, ...)");
  }
  if (token.kind == TokenKind::unit) {
    fail(token.span, fmt::format("unexpected unit '[{}]'", shown(token.text)),
         "units stand after coordinates, momenta, parameters and time; a subscript stands directly "
         "after its name");
  }
  if (is_symbol(token, "{") || is_symbol(token, "}")) {
    fail(token.span, fmt::format("'{}' does not belong in an expression", token.text),
         "write parentheses: (q + p)");
  }
}

}  // namespace hamgen
