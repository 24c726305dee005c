// H as a sum of indexed sums.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/language/model.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

// Calls visit(child) for each operand of the node.
template <class Visit>
void for_children(const NodePtr& node, Visit visit) {
  if (const auto* n = std::get_if<NameNode>(&node->value)) {
    if (n->subscript) visit(n->subscript);
  } else if (const auto* negate = std::get_if<NegateNode>(&node->value)) {
    visit(negate->operand);
  } else if (const auto* binary = std::get_if<BinaryNode>(&node->value)) {
    visit(binary->left);
    visit(binary->right);
  } else if (const auto* call = std::get_if<CallNode>(&node->value)) {
    for (const NodePtr& argument : call->arguments) visit(argument);
  } else if (const auto* sum = std::get_if<SumNode>(&node->value)) {
    visit(sum->body);
  }
}

// What is summed: a body without sums and factors (divided by, if so marked).
struct Summand {
  NodePtr body;
  std::vector<std::pair<NodePtr, bool>> factors;
  bool negative = false;
};

// Which variables an expression mentions.
struct Touch {
  bool coordinates = false;
  bool momenta = false;
  [[nodiscard]] bool both() const { return coordinates && momenta; }
  bool operator==(const Touch&) const = default;
};

// The subscripts that each variable has, where they are two or more: springs to the next element
// and to the next but one are two sums, or algebra would add what both have of an element, and
// differences would become sums that cancel.
using Distances = std::map<std::string, std::set<std::string>>;

// A sum of H: what is summed over the same indices, depends on the same part of the state and is
// between elements of the same distances becomes one loop.
struct SumTerm {
  std::vector<KernelRange> ranges;
  Touch touch;
  std::vector<Summand> summands;
  Distances distances = {};
};

struct SplitSums {
  std::vector<SumTerm> terms;
  std::vector<Summand> functions;  // of sums, which stand in them: C^2
};

// The formula, split at plus and minus and at its sums; definitions that hold sums are followed.
// Empty if a sum stands inside another one where it cannot be split off.
[[nodiscard]] std::optional<SplitSums> split_into_sums(const Model& model, const NodePtr& formula);
// Does a sum stand there, or in a definition that is named there?
[[nodiscard]] bool contains_sum(const Model& model, const NodePtr& node);
[[nodiscard]] const Definition* find_definition(const Model& model, const std::string& name);

// The integer expression as an affine function of the indices; empty if it is none.
[[nodiscard]] std::optional<AffineIndex> affine(const Model& model, const NodePtr& node,
                                                const std::vector<std::string>& indices);

}  // namespace hamgen
