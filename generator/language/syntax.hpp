// The statements of a .ham file as written, before any name has a meaning.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/language/ast.hpp"
#include "generator/language/model.hpp"
#include "generator/language/token.hpp"

namespace hamgen {

struct Name {
  std::string text;
  Span span;
};

struct RangeSyntax {
  NodePtr first;
  NodePtr last;
  Span span;
};

struct Declarator {  // q, q[1..N] [rad]
  Name name;
  std::optional<RangeSyntax> range;
  std::string unit;
};

struct BoundarySyntax {  // q[0] = 0
  Name name;
  NodePtr subscript;
  NodePtr value;
};

struct VariableStatement {  // coordinate ..., momentum ..., time t
  std::vector<Declarator> declarators;
  bool periodic = false;
  std::vector<BoundarySyntax> boundary;
  std::string comment;
};

struct ParameterStatement {
  Declarator declarator;
  std::vector<NodePtr> values;
  bool is_list = false;
  Span value_span;
  std::string comment;
};

struct Formula {  // let, H, invariant, size
  Name name;
  NodePtr value;
  std::string text;  // the value as written, on one line and without comments
  std::string comment;
};

struct SceneStatement {
  Scene scene;
};

// Statements of a kind in source order.
struct Syntax {
  std::vector<Name> systems;
  std::vector<Formula> sizes;
  std::vector<VariableStatement> coordinates;
  std::vector<VariableStatement> momenta;
  std::vector<VariableStatement> times;
  std::vector<ParameterStatement> parameters;
  std::vector<Formula> definitions;
  std::vector<Formula> hamiltonians;
  std::vector<Formula> invariants;
  std::vector<ModelEvent> events;
  std::vector<SceneStatement> scenes;
  std::vector<Diagnostic> diagnostics;
  bool variables_are_read = true;    // no line that could not be read may have declared one
  std::vector<std::string> spoiled;  // names on lines that could not be read: silent if unknown
  std::size_t looks = 0;             // of the parser at a token: the work it did
};

}  // namespace hamgen
