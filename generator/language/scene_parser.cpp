#include "generator/language/scene_parser.hpp"

#include <fmt/format.h>

#include <utility>

#include "generator/base/utf8.hpp"
#include "generator/language/words.hpp"

namespace hamgen {
namespace {

bool at_setting_end(const ExpressionParser& in) {
  return in.at_line_end() || is_symbol(in.peek(), ";") || is_symbol(in.peek(), "}");
}

// A line that belongs to no scene; "time = 20" is a setting that there is not.
bool at_statement(const ExpressionParser& in) {
  const std::string_view word = in.peek().text;
  return begins_statement(word) && (word == "H" || !is_symbol(in.peek(1), "="));
}

// observe energy, L
void observe(ExpressionParser& in, SceneStatement& statement) {
  in.next();
  for (Observed& each : observed_list(in)) statement.scene.observe.push_back(std::move(each));
}

// h = 0.1, steps = 1000, every = 10: each once, and one number.
NodePtr* run_setting(Scene& scene, std::string_view name) {
  if (name == "h") return &scene.h;
  if (name == "steps") return &scene.steps;
  if (name == "every") return &scene.every;
  return nullptr;
}

void read_setting(ExpressionParser& in, SceneStatement& statement) {
  const Token& first = in.peek();
  if (first.kind == TokenKind::name && first.text == "observe") {
    observe(in, statement);
  } else {
    Setting read = setting(in);
    if (NodePtr* place = run_setting(statement.scene, read.name)) {
      if (*place) in.fail(read.span, fmt::format("'{}' is set twice", read.name), "keep one");
      if (read.is_list || read.element) {
        in.fail(read.span, fmt::format("'{}' is one number", read.name),
                fmt::format("write {} = 10", read.name));
      }
      *place = read.values.front();
    } else {
      statement.scene.settings.push_back(std::move(read));
    }
  }
  if (!at_setting_end(in)) in.expect_operator_or_end();
}

}  // namespace

std::vector<Observed> observed_list(ExpressionParser& in) {
  std::vector<Observed> list;
  do {
    while (in.peek().kind == TokenKind::newline) in.next();
    const Token& token = in.peek();
    if (token.kind != TokenKind::name) {
      in.expected("a name", "write observe energy, q or radius = sqrt(x^2 + y^2)");
    }
    in.next();
    Observed observed{.name = std::string(token.text), .element = {}};
    if (in.accept("[")) {
      observed.element = in.expression();
      if (!in.accept("]")) in.expected("']'", "write q[2]");
    }
    observed.span = {token.span.begin, in.previous().span.end};
    if (in.accept("=")) {
      observed.value = in.expression();
      observed.text = to_text(observed.value);
    } else if (const Token& next = in.peek();
               next.kind == TokenKind::symbol &&
               std::string_view("+-*/^(").find(next.text) != std::string_view::npos) {
      in.fail(next.span, "what is computed gets a name of its own",
              "write observe radius = sqrt(x^2 + y^2)");
    }
    list.push_back(std::move(observed));
  } while (in.accept(","));
  return list;
}

std::vector<NodePtr> value_list(ExpressionParser& in) {
  const Token& opener = in.next();
  std::vector<NodePtr> values;
  do {
    values.push_back(in.expression());
  } while (in.accept(","));
  if (!in.accept("]")) {
    if (in.at_line_end()) in.fail(opener.span, "'[' is never closed", "add ']'");
    in.expected("',' or ']'", "a list is written [1, 2, 3]");
  }
  return values;
}

Setting setting(ExpressionParser& in) {
  const Token& name = in.peek();
  if (name.kind != TokenKind::name) {
    in.expected("a setting", "write q = 1, h = 0.1, steps = 1000 or observe energy");
  }
  in.next();
  Setting result;
  result.name = name.text;
  if (in.accept("[")) {
    result.element = in.expression();
    if (!in.accept("]")) in.expected("']'", "write q[2] = 1 or q[i] = sin(i)");
  }
  if (!in.accept("=")) in.expected("'='", fmt::format("write {} = 1", printable(name.text)));
  result.is_list = is_symbol(in.peek(), "[");
  result.values = result.is_list ? value_list(in) : std::vector<NodePtr>{in.expression()};
  result.span = {name.span.begin, in.previous().span.end};
  return result;
}

SceneStatement parse_scene(ExpressionParser& in, const Name& name,
                           std::vector<Diagnostic>& diagnostics) {
  SceneStatement statement;
  statement.scene.name = name.text;
  statement.scene.span = name.span;
  while (in.peek().kind == TokenKind::newline && is_symbol(in.peek(1), "{")) in.next();
  if (!in.accept("{")) in.expected("'{'", "write scene NAME { q = 1 }");
  const Span opener = in.previous().span;
  if (in.peek().kind == TokenKind::newline) statement.scene.comment = in.peek().text;
  while (!in.accept("}")) {
    if (in.peek().kind == TokenKind::end || at_statement(in)) {
      diagnostics.push_back({Severity::error, opener, "'{' is never closed", "add '}'"});
      return statement;
    }
    try {
      if (at_setting_end(in)) {
        if (!is_symbol(in.peek(), "}")) in.next();
      } else {
        read_setting(in, statement);
      }
    } catch (const SyntaxError& error) {
      if (error.diagnostic) diagnostics.push_back(*error.diagnostic);
      while (!at_setting_end(in)) in.next();
    }
  }
  return statement;
}

}  // namespace hamgen
