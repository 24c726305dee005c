#include "generator/language/parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "generator/base/utf8.hpp"
#include "generator/language/expression_parser.hpp"
#include "generator/language/lexer.hpp"
#include "generator/language/scene_parser.hpp"
#include "generator/language/words.hpp"

namespace hamgen {
namespace {

class Parser {
 public:
  explicit Parser(const SourceText& source)
      : source_(source), lexed_(read_tokens(source)), in_(lexed_.tokens) {
    syntax_.diagnostics = lexed_.diagnostics;
  }

  Syntax run() {
    while (in_.peek().kind != TokenKind::end) {
      const std::size_t begin = in_.peek().span.begin;
      try {
        if (!in_.at_line_end()) statement();
        if (in_.at_line_end()) in_.next();
      } catch (const SyntaxError& error) {
        if (error.diagnostic) syntax_.diagnostics.push_back(*error.diagnostic);
        while (!in_.at_line_end()) in_.next();
        spoil(begin, in_.peek().span.begin);
      }
    }
    syntax_.looks += in_.looks();
    return std::move(syntax_);
  }

 private:
  // What a line would have declared, had it been right.
  void spoil(std::size_t begin, std::size_t end) {
    static const std::set<std::string_view> others = {"system",    "parameter", "let",  "H",
                                                      "invariant", "event",     "scene"};
    const auto at = [this](std::size_t offset) {
      return std::ranges::lower_bound(lexed_.tokens, offset, {},
                                      [](const Token& token) { return token.span.begin; });
    };
    const auto first = at(begin);
    for (auto token = first, last = at(end); token != last; ++token) {
      ++syntax_.looks;
      if (token->kind == TokenKind::name) syntax_.spoiled.emplace_back(token->text);
      if (token == first && !others.contains(token->text)) syntax_.variables_are_read = false;
    }
  }

  void statement() {
    const Token& word = in_.peek();
    if (word.kind == TokenKind::symbol && word.text.find_first_of("+-*/^") == 0) {
      in_.fail(word.span, fmt::format("a statement cannot begin with '{}'", word.text),
               "a line goes on only inside parentheses: H = (... + ...)");
    }
    if (word.kind != TokenKind::name) {
      in_.fail(word.span, "expected a statement",
               "a statement begins with " + fmt::format("{}", fmt::join(statement_words(), ", ")));
    }
    in_.next();
    if (word.text == "system") return system();
    if (word.text == "size") return syntax_.sizes.push_back(formula("size"));
    if (word.text == "coordinate") return syntax_.coordinates.push_back(variables());
    if (word.text == "momentum") return syntax_.momenta.push_back(variables());
    if (word.text == "time") return time();
    if (word.text == "parameter") return parameter();
    if (word.text == "let") return syntax_.definitions.push_back(formula("let"));
    if (word.text == "H") return hamiltonian(word);
    if (word.text == "invariant") return syntax_.invariants.push_back(formula("invariant"));
    if (word.text == "event") return event();
    if (word.text == "scene") return scene();
    unknown_statement(word);
  }

  [[noreturn]] void unknown_statement(const Token& word) {
    const std::string near = nearest(word.text, statement_words());
    std::string help =
        "a statement begins with " + fmt::format("{}", fmt::join(statement_words(), ", "));
    if (is_symbol(in_.peek(), "=")) {
      help = word.text == "h"
                 ? "the energy is H = ...; h is the step, which a scene gives"
                 : fmt::format("write 'let {0} = ...' or 'parameter {0} = ...'", word.text);
    } else if (!near.empty()) {
      help = fmt::format("did you mean '{}'?", near);
    }
    in_.fail(word.span, fmt::format("unknown statement '{}'", printable(word.text)), help);
  }

  // Ends a statement; returns the comment behind it.
  std::string end() {
    if (!in_.at_line_end()) {
      in_.fail(in_.peek().span,
               fmt::format("expected the end of the line, found '{}'", printable(in_.peek().text)),
               "one statement a line");
    }
    return std::string(in_.peek().text);
  }

  Name new_name(std::string_view example) {
    const Token& token = in_.peek();
    if (token.kind != TokenKind::name) in_.expected("a name", fmt::format("write {}", example));
    in_.next();
    check_free(token);
    return {std::string(token.text), token.span};
  }

  void check_free(const Token& token) const {
    const std::string meaning = reserved_meaning(token.text);
    if (meaning.empty()) return;
    in_.fail(token.span, fmt::format("'{}' is reserved: {}", token.text, meaning),
             "choose another name");
  }

  void equals(std::string_view example) {
    if (!in_.accept("=")) in_.expected("'='", fmt::format("write {}", example));
  }

  void system() {
    const Token& token = in_.peek();
    if (token.kind != TokenKind::name) in_.expected("a name", "write system pendulum");
    in_.next();
    syntax_.systems.push_back({std::string(token.text), token.span});
    end();
  }

  Formula formula(std::string_view keyword) {
    const std::string example = keyword == "size"  ? "size N = 10"
                                : keyword == "let" ? "let r2 = q1^2 + q2^2"
                                                   : "invariant L = q1*p2 - q2*p1";
    Formula result{.name = new_name(example), .value = {}, .text = {}, .comment = {}};
    if (is_symbol(in_.peek(), "(") || is_symbol(in_.peek(), "[")) {
      in_.fail(in_.peek().span, fmt::format("a {} has no arguments and no index", keyword),
               keyword == "let" ? "write " + example + ", and what has an index within its sum"
                                : "write " + example);
    }
    equals(example);
    finish(result);
    return result;
  }

  void finish(Formula& formula) {
    const std::size_t begin = in_.peek().span.begin;
    formula.value = in_.expression();
    in_.expect_operator_or_end();
    formula.text = one_line(source_, {begin, in_.previous().span.end});
    formula.comment = end();
  }

  void hamiltonian(const Token& word) {
    Formula result{.name = {"H", word.span}, .value = {}, .text = {}, .comment = {}};
    if (is_symbol(in_.peek(), "(")) {
      in_.fail(in_.peek().span, "H is written without arguments", "write H = ...");
    }
    equals("H = p^2/2 - cos(q)");
    finish(result);
    syntax_.hamiltonians.push_back(std::move(result));
  }

  Declarator declarator(std::string_view example) {
    Declarator result{.name = new_name(example), .range = {}, .unit = {}};
    if (is_symbol(in_.peek(), "[")) {
      const Token& opener = in_.next();
      RangeSyntax range{.first = in_.expression(), .last = {}, .span = {}};
      if (!in_.accept("..")) in_.expected("'..'", "a range is written q[1..N]");
      range.last = in_.expression();
      if (is_symbol(in_.peek(), ",")) {
        in_.fail(in_.peek().span, "an array has one index",
                 "write q[1..N*M], and q[(i-1)*M+j] for an element of N rows of M");
      }
      if (!in_.accept("]")) in_.expected("']'", "a range is written q[1..N]");
      range.span = {opener.span.begin, in_.previous().span.end};
      result.range = std::move(range);
    }
    if (in_.peek().kind == TokenKind::unit) {
      const Token& unit = in_.next();
      if (unit.text.find("..") != std::string_view::npos) {
        in_.fail(unit.span, "a space before a range makes it a unit",
                 fmt::format("write {}[{}]", result.name.text, printable(unit.text)));
      }
      result.unit = unit.text;
    }
    return result;
  }

  bool accept_word(std::string_view word) {
    if (in_.peek().kind != TokenKind::name || in_.peek().text != word) return false;
    in_.next();
    return true;
  }

  VariableStatement variables() {
    VariableStatement result;
    do {
      result.declarators.push_back(declarator("coordinate q, or coordinate q[1..N]"));
    } while (in_.accept(","));
    // coordinate x, y [m]: the unit of the last name is the unit of all that have none.
    for (Declarator& each : result.declarators) {
      if (each.unit.empty()) each.unit = result.declarators.back().unit;
    }
    if (accept_word("periodic")) {
      result.periodic = true;
    } else if (accept_word("with")) {
      do {
        result.boundary.push_back(boundary());
      } while (in_.accept(","));
    }
    if (in_.peek().kind == TokenKind::name) {
      in_.fail(in_.peek().span, fmt::format("unexpected '{}'", in_.peek().text),
               "separate names by commas; an array may end in 'periodic' or 'with q[0] = 0'");
    }
    if (in_.peek().kind == TokenKind::unit) {
      const std::string unit = printable(in_.peek().text);
      in_.fail(in_.peek().span, fmt::format("the unit '[{}]' stands too late", unit),
               fmt::format("write [{}] behind the name, before 'periodic' or 'with'", unit));
    }
    result.comment = end();
    return result;
  }

  BoundarySyntax boundary() {
    const std::string_view example = "with q[0] = 0, q[N+1] = 0";
    const Token& token = in_.peek();
    if (token.kind != TokenKind::name) in_.expected("a name", fmt::format("write {}", example));
    in_.next();
    BoundarySyntax result{
        .name = {std::string(token.text), token.span}, .subscript = {}, .value = {}};
    if (!in_.accept("[")) in_.expected("'['", fmt::format("write {}", example));
    result.subscript = in_.expression();
    if (!in_.accept("]")) in_.expected("']'", fmt::format("write {}", example));
    equals(example);
    result.value = in_.expression();
    return result;
  }

  void time() {
    VariableStatement result;
    result.declarators.push_back(declarator("time t"));
    if (result.declarators.front().range) {
      in_.fail(result.declarators.front().range->span, "time is not an array", "write time t");
    }
    result.comment = end();
    syntax_.times.push_back(std::move(result));
  }

  void parameter() {
    ParameterStatement result;
    result.declarator = declarator("parameter m = 1");
    equals(fmt::format("parameter {} = 1", result.declarator.name.text));
    const std::size_t begin = in_.peek().span.begin;
    result.is_list = is_symbol(in_.peek(), "[");
    reject_bare_unit();
    result.values = result.is_list ? value_list(in_) : std::vector<NodePtr>{in_.expression()};
    result.value_span = {begin, in_.previous().span.end};
    if (in_.peek().kind == TokenKind::unit) result.declarator.unit = in_.next().text;
    if (is_symbol(in_.peek(), ",") && in_.peek(1).kind == TokenKind::name)
      in_.fail(in_.peek().span, "expected an operator or the end of the line, found ','",
               fmt::format("one parameter a line: parameter {} = ...", in_.peek(1).text));
    if (!result.is_list) in_.expect_operator_or_end();
    result.comment = end();
    syntax_.parameters.push_back(std::move(result));
  }

  // "parameter m = 1 kg"
  void reject_bare_unit() const {
    const Token& number = in_.peek();
    const Token& unit = in_.peek(1);
    const TokenKind behind = in_.peek(2).kind;
    const bool ends = behind == TokenKind::newline || behind == TokenKind::end;
    if (number.kind != TokenKind::number || unit.kind != TokenKind::name || !ends) return;
    in_.fail({number.span.begin, unit.span.end},
             fmt::format("missing operator between '{}' and '{}'", number.text, unit.text),
             fmt::format("write {0} [{1}] if {1} is a unit, {0}*{1} for a product", number.text,
                         unit.text));
  }

  // event hit = r - 1e-3 falling
  void event() {
    const std::string_view example = "event hit = r - 1e-3 falling";
    const Name name = new_name(example);
    equals(example);
    ModelEvent result = crossing(in_, source_);
    result.name = name.text;
    result.span = name.span;
    in_.expect_operator_or_end();
    result.comment = end();
    syntax_.events.push_back(std::move(result));
  }

  void scene() {
    const Token& name = in_.peek();
    if (name.kind != TokenKind::name) in_.expected("a name", "write scene NAME { ... }");
    in_.next();
    syntax_.scenes.push_back(
        parse_scene(in_, {std::string(name.text), name.span}, syntax_.diagnostics));
    if (is_symbol(in_.previous(), "}")) end();
  }

  const SourceText& source_;
  Tokens lexed_;
  ExpressionParser in_;
  Syntax syntax_;
};

// Runs `read` on the tokens of a text of one line, as an option of the command line is.
template <typename Read>
auto parse_alone(const SourceText& source, Read read) {
  const Tokens lexed = read_tokens(source);
  ExpressionParser in(lexed.tokens);
  std::vector<Diagnostic> diagnostics = lexed.diagnostics;
  try {
    auto result = read(in);
    in.expect_operator_or_end();
    while (in.peek().kind == TokenKind::newline) in.next();
    if (in.peek().kind != TokenKind::end)
      in.fail(in.peek().span, "a second line", "an expression goes on inside parentheses only");
    if (diagnostics.empty()) return result;
  } catch (const SyntaxError& error) {
    if (error.diagnostic) diagnostics.push_back(*error.diagnostic);
  }
  throw ModelError(diagnostics, source);
}

}  // namespace

Syntax parse(const SourceText& source) { return Parser(source).run(); }

Setting parse_setting(const SourceText& source) {
  return parse_alone(source, [](ExpressionParser& in) { return setting(in); });
}

std::vector<Observed> parse_observed(const SourceText& source) {
  return parse_alone(source, [](ExpressionParser& in) { return observed_list(in); });
}

EndSyntax parse_end_of_run(const SourceText& source) {
  return parse_alone(source, [&](ExpressionParser& in) { return end_of_run(in, source); });
}

NodePtr parse_expression(const SourceText& source) {
  return parse_alone(source, [](ExpressionParser& in) { return in.expression(); });
}

std::string one_line(const SourceText& source, Span span) {
  std::string result;
  bool space = false;
  for (std::size_t i = span.begin; i < span.end; ++i) {
    const char c = source.text[i];
    if (c == '#') {
      i = std::min(span.end, source.text.find('\n', i)) - 1;
    } else if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
      space = true;
    } else {
      if (space && !result.empty()) result += ' ';
      space = false;
      result += c;
    }
  }
  return result;
}

}  // namespace hamgen
