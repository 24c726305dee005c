// A checked expression as the user wrote it: every node knows its place in the source.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "generator/algebra/exact.hpp"
#include "generator/base/source_text.hpp"

namespace hamgen {

struct Node;
using NodePtr = std::shared_ptr<const Node>;

struct NumberNode {
  Rational value;
};
// A name with at most one subscript: "q", "q[i+1]".  "pi" is a NameNode too.
struct NameNode {
  std::string name;
  NodePtr subscript;  // null for a scalar
};
struct NegateNode {
  NodePtr operand;
};
enum class BinaryOperator { add, subtract, multiply, divide, power };
struct BinaryNode {
  BinaryOperator operation = BinaryOperator::add;
  NodePtr left;
  NodePtr right;
};
struct CallNode {
  std::string function;
  std::vector<NodePtr> arguments;
};
struct SumRange {
  std::string index;
  NodePtr lower;  // integer expressions in sizes and outer indices
  NodePtr upper;
  Span span;
};
// sum(i = 1..N, j = i+1..N, body): ranges from the outermost to the innermost.
struct SumNode {
  std::vector<SumRange> ranges;
  NodePtr body;
};

struct Node {
  Span span;
  std::variant<NumberNode, NameNode, NegateNode, BinaryNode, CallNode, SumNode> value;
};

}  // namespace hamgen
