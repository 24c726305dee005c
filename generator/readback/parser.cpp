#include <fmt/format.h>

#include <array>

#include "generator/readback/findings.hpp"
#include "generator/readback/syntax.hpp"

namespace hamgen {

namespace {

using ParsedKind = CppExpression::Kind;

constexpr int kDeepest = 400;        // brackets within brackets
constexpr int kLongestChain = 5000;  // a chain of operators without brackets

// Operators from the weakest on; those of one row are read from the left.
constexpr std::array<std::array<std::string_view, 4>, 8> kOperators = {{{"||"},
                                                                        {"&&"},
                                                                        {"|"},
                                                                        {"&"},
                                                                        {"==", "!="},
                                                                        {"<", ">", "<=", ">="},
                                                                        {"+", "-"},
                                                                        {"*", "/", "%"}}};

class CppReader {
 public:
  explicit CppReader(TokenCursor& cursor) : cursor_(cursor) {}

  CppFunction function(bool of_class) {
    while (cursor_.accept("[")) {
      cursor_.expect("[");
      cursor_.expect("nodiscard");
      if (cursor_.accept(",")) {
        for (const char* part : {"gnu", "::", "always_inline"}) cursor_.expect(part);
      }
      cursor_.expect("]");
      cursor_.expect("]");
    }
    cursor_.accept("static");
    if (!of_class) cursor_.expect("inline");
    CppFunction result;
    result.line = cursor_.line();
    result.type = type();
    result.name = cursor_.word();
    cursor_.expect("(");
    while (!cursor_.accept(")")) {
      if (!result.arguments.empty()) cursor_.expect(",");
      result.arguments.push_back(argument());
    }
    result.body = block();
    return result;
  }

  CppExpression expression() {
    const Deeper deeper(*this);
    CppExpression left = choice();
    for (const std::string_view sign : {"=", "+=", "-=", "*=", "/="}) {
      if (!cursor_.peek().is(sign)) continue;
      const int line = cursor_.take().line;
      CppExpression right = expression();
      return {ParsedKind::binary, std::string(sign), {std::move(left), std::move(right)}, line};
    }
    return left;
  }

 private:
  struct Deeper {
    explicit Deeper(CppReader& reader) : of(reader) {
      if (++of.depth_ > kDeepest)
        throw TextNotUnderstood(of.cursor_.line(), "brackets that are nested too deeply");
    }
    ~Deeper() { --of.depth_; }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;
    CppReader& of;
  };

  std::string type() {
    std::string text = cursor_.word();
    while (cursor_.accept("::")) text += "::" + cursor_.word();
    // "long long", "long double"
    while (text == "long" && (cursor_.peek().is("long") || cursor_.peek().is("double")))
      text += " " + cursor_.word();
    if (cursor_.accept("<")) {
      text += "<";
      while (!cursor_.peek().is(">")) {
        const CppToken::Kind kind = cursor_.peek().kind;
        const bool belongs = kind == CppToken::Kind::word || kind == CppToken::Kind::number;
        if (!belongs && !cursor_.peek().is(","))
          throw TextNotUnderstood(cursor_.line(), "a type that is none of the emitted ones");
        text += cursor_.take().text;
      }
      cursor_.take();
      text += ">";
    }
    return text;
  }

  CppArgument argument() {
    CppArgument result;
    result.constant = cursor_.accept("const");
    result.type = type();
    if (cursor_.accept("&")) result.pass = CppArgument::Pass::reference;
    if (cursor_.accept("*")) result.pass = CppArgument::Pass::pointer;
    result.alone = cursor_.accept("__restrict");
    if (cursor_.accept("(")) {
      result.pass = CppArgument::Pass::array;
      cursor_.expect("&");
      if (cursor_.peek().kind == CppToken::Kind::word) result.name = cursor_.word();
      cursor_.expect(")");
    } else if (cursor_.peek().kind == CppToken::Kind::word) {
      result.name = cursor_.word();
    }
    result.sizes = sizes();
    return result;
  }

  std::vector<CppExpression> sizes() {
    std::vector<CppExpression> result;
    while (cursor_.accept("[")) {
      result.push_back(expression());
      cursor_.expect("]");
    }
    return result;
  }

  std::vector<CppStatement> block() {
    std::vector<CppStatement> result;
    cursor_.expect("{");
    while (!cursor_.accept("}")) {
      if (cursor_.at_end()) throw TextNotUnderstood(cursor_.line(), "a block without an end");
      statement(result);
    }
    return result;
  }

  std::vector<CppStatement> body() {
    if (cursor_.peek().is("{")) return block();
    std::vector<CppStatement> result;
    statement(result);
    return result;
  }

  // One, none if it is empty, or those that declare the names of a list.
  void statement(std::vector<CppStatement>& to) {
    const Deeper deeper(*this);
    const int line = cursor_.line();
    if (cursor_.accept(";")) return;
    if (cursor_.peek().is("{"))
      return to.push_back({.kind = CppStatement::Kind::block, .line = line, .body = block()});
    if (cursor_.accept("if")) return to.push_back(branch(line));
    if (cursor_.accept("for")) return to.push_back(loop(line));
    CppStatement result{.line = line};
    if (cursor_.accept("return")) {
      result.kind = CppStatement::Kind::result;
      if (!cursor_.peek().is(";")) result.value = expression();
    } else if (cursor_.accept("break")) {
      result.kind = CppStatement::Kind::leave;
    } else if (cursor_.accept("continue")) {
      result.kind = CppStatement::Kind::next;
    } else if (declares()) {
      result = declaration();
      while (cursor_.accept(",")) {
        to.push_back(result);
        result.name = cursor_.word();
      }
    } else {
      result.value = expression();
    }
    cursor_.expect(";");
    to.push_back(std::move(result));
  }

  CppStatement branch(int line) {
    CppStatement result{.kind = CppStatement::Kind::branch, .line = line};
    cursor_.expect("(");
    result.value = expression();
    cursor_.expect(")");
    result.body = body();
    return result;
  }

  CppStatement loop(int line) {
    CppStatement result{.kind = CppStatement::Kind::loop, .line = line};
    cursor_.expect("(");
    result.first.push_back(declaration());
    if (cursor_.accept(":")) {
      result.kind = CppStatement::Kind::each;
      result.value = expression();
      cursor_.expect(")");
      result.body = body();
      return result;
    }
    cursor_.expect(";");
    if (!cursor_.peek().is(";")) result.value = expression();
    cursor_.expect(";");
    if (!cursor_.peek().is(")")) result.advance = expression();
    cursor_.expect(")");
    result.body = body();
    return result;
  }

  // A type is followed by a name.
  bool declares() {
    if (cursor_.peek().is("const")) return true;
    const std::size_t begin = cursor_.position();
    bool found = false;
    try {
      static_cast<void>(type());
      found = cursor_.peek().kind == CppToken::Kind::word;
    } catch (const TextNotUnderstood&) {
    }
    cursor_.go_to(begin);
    return found;
  }

  CppStatement declaration() {
    CppStatement result{.kind = CppStatement::Kind::declaration, .line = cursor_.line()};
    cursor_.accept("const");
    result.type = type();
    if (cursor_.accept("&")) result.type += "&";
    result.name = cursor_.word();
    result.sizes = sizes();
    if (cursor_.accept("=")) result.value = expression();
    return result;
  }

  CppExpression choice() {
    const Deeper deeper(*this);
    CppExpression condition = operation(0);
    if (!cursor_.peek().is("?")) return condition;
    const int line = cursor_.take().line;
    CppExpression yes = choice();
    cursor_.expect(":");
    CppExpression no = choice();
    return {ParsedKind::choice, "?", {std::move(condition), std::move(yes), std::move(no)}, line};
  }

  void require_short(int length) const {
    if (length > kLongestChain)
      throw TextNotUnderstood(cursor_.line(), "a formula that is too long");
  }

  bool is_operator(std::size_t row) const {
    for (const std::string_view sign : kOperators[row]) {
      if (!sign.empty() && cursor_.peek().kind == CppToken::Kind::sign && cursor_.peek().is(sign))
        return true;
    }
    return false;
  }

  CppExpression operation(std::size_t row) {
    if (row == kOperators.size()) return unary();
    CppExpression left = operation(row + 1);
    for (int length = 0; is_operator(row); ++length) {
      const CppToken& sign = cursor_.take();
      require_short(length);
      CppExpression whole{ParsedKind::binary, sign.text, {}, sign.line};
      whole.parts.reserve(2);
      whole.parts.push_back(std::move(left));
      whole.parts.push_back(operation(row + 1));
      left = std::move(whole);
    }
    return left;
  }

  CppExpression unary() {
    if (cursor_.peek().is("(") && cursor_.peek(1).is("void")) {
      const Deeper deeper(*this);
      const int line = cursor_.line();
      for (const char* sign : {"(", "void", ")"}) cursor_.expect(sign);
      return {ParsedKind::prefix, "(void)", {unary()}, line};
    }
    for (const std::string_view sign : {"-", "!", "++", "--", "&", "*"}) {
      if (!cursor_.peek().is(sign)) continue;
      const Deeper deeper(*this);
      const int line = cursor_.take().line;
      CppExpression operand = unary();
      return {ParsedKind::prefix, std::string(sign), {std::move(operand)}, line};
    }
    return postfix(primary());
  }

  CppExpression primary() {
    const CppToken& token = cursor_.peek();
    const int line = token.line;
    if (cursor_.accept("(")) {
      CppExpression inner = expression();
      cursor_.expect(")");
      return inner;
    }
    if (token.is("{")) return list();
    if (token.kind == CppToken::Kind::number)
      return {ParsedKind::number, cursor_.take().text, {}, line};
    if (token.kind == CppToken::Kind::quoted)
      return {ParsedKind::quoted, cursor_.take().text, {}, line};
    std::string name = cursor_.word();
    while (cursor_.accept("::")) name += "::" + cursor_.word();
    if (name == "static_cast") {
      for (const char* sign : {"<", "void", ">"}) cursor_.expect(sign);
      name += "<void>";
    }
    // Of lanes, one after the other: library<std::sin>.
    if (name == "library" && cursor_.accept("<")) {
      name = cursor_.word();
      while (cursor_.accept("::")) name += "::" + cursor_.word();
      cursor_.expect(">");
      name = "library<" + name + ">";
    }
    return {ParsedKind::name, std::move(name), {}, line};
  }

  CppExpression list() {
    CppExpression result{ParsedKind::list, "{}", {}, cursor_.line()};
    cursor_.expect("{");
    while (!cursor_.accept("}")) {
      if (!result.parts.empty()) cursor_.expect(",");
      result.parts.push_back(choice());
    }
    return result;
  }

  CppExpression postfix(CppExpression of) {
    for (int length = 0;; ++length) {
      require_short(length);
      const int line = cursor_.line();
      if (cursor_.accept("(")) {
        CppExpression call{ParsedKind::call, "", {}, line};
        call.parts.push_back(std::move(of));
        while (!cursor_.accept(")")) {
          if (call.parts.size() > 1) cursor_.expect(",");
          call.parts.push_back(choice());
        }
        of = std::move(call);
      } else if (cursor_.accept("[")) {
        CppExpression index = expression();
        cursor_.expect("]");
        of = {ParsedKind::index, "[]", {std::move(of), std::move(index)}, line};
      } else if (cursor_.peek().is(".") || cursor_.peek().is("->")) {
        const bool arrow = cursor_.take().is("->");
        std::string member = cursor_.word();
        of = {ParsedKind::member, std::move(member), {std::move(of)}, line, arrow};
      } else if (cursor_.peek().is("++") || cursor_.peek().is("--")) {
        of = {ParsedKind::postfix, cursor_.take().text, {std::move(of)}, line};
      } else {
        return of;
      }
    }
  }

  TokenCursor& cursor_;
  int depth_ = 0;
};

}  // namespace

CppFunction read_function(TokenCursor& cursor, bool of_class) {
  return CppReader(cursor).function(of_class);
}
CppExpression read_cpp_expression(TokenCursor& cursor) { return CppReader(cursor).expression(); }

}  // namespace hamgen
