// Emitted functions as trees, as C++ itself reads them: nothing is known here of steps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/readback/tokens.hpp"

namespace hamgen {

struct CppExpression {
  enum class Kind {
    name,    // "std::sin"
    number,  // as it is written
    quoted,
    prefix,   // text: - ! ++ -- & * (void)
    postfix,  // text: ++ --
    binary,   // text: the operator; of assignments too
    choice,   // a ? b : c
    call,     // the callee, then the arguments
    index,    // a[b]
    member,   // text: the member
    list,     // {a, b}
  };
  Kind kind = Kind::name;
  std::string text;
  std::vector<CppExpression> parts = {};
  int line = 0;
  bool arrow = false;  // of a member: "->", not "."

  [[nodiscard]] bool is_name(std::string_view name) const {
    return kind == Kind::name && text == name;
  }
  [[nodiscard]] bool is_binary(std::string_view sign) const {
    return kind == Kind::binary && text == sign;
  }
};

struct CppStatement {
  enum class Kind { declaration, expression, block, branch, loop, each, result, leave, next };
  Kind kind = Kind::expression;
  int line = 0;
  std::string type = {};  // of a declaration, without const: "DenseMatrix<4>"
  std::string name = {};
  std::vector<CppExpression> sizes = {};
  // The value that is declared or returned, the expression, the condition, or what a loop is over.
  std::optional<CppExpression> value = {};
  std::vector<CppStatement> first = {};       // of a loop: one declaration
  std::optional<CppExpression> advance = {};  // of a loop
  std::vector<CppStatement> body = {};
};

struct CppArgument {
  bool constant = false;
  std::string type;  // "Real"
  enum class Pass { value, reference, pointer, array };
  Pass pass = Pass::value;
  bool alone = false;  // "__restrict"
  std::string name;
  std::vector<CppExpression> sizes;
};

struct CppFunction {
  std::string type;
  std::string name;
  std::vector<CppArgument> arguments;
  std::vector<CppStatement> body;
  int line = 0;
};

// Throws TextNotUnderstood.
[[nodiscard]] CppFunction read_function(TokenCursor& cursor, bool of_class = false);
[[nodiscard]] CppExpression read_cpp_expression(TokenCursor& cursor);

}  // namespace hamgen
