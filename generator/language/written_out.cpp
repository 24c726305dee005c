#include "generator/language/written_out.hpp"

namespace hamgen {
namespace {

struct Counter {
  const std::map<std::string, double>& definitions;

  double operator()(const NodePtr& node) const { return std::visit(*this, node->value); }
  double operator()(const NumberNode&) const { return 0; }
  double operator()(const NameNode& name) const {
    const auto found = definitions.find(name.name);
    return found == definitions.end() ? 0 : found->second;
  }
  double operator()(const NegateNode& negate) const { return (*this)(negate.operand); }
  double operator()(const BinaryNode& binary) const {
    return 1 + (*this)(binary.left) + (*this)(binary.right);
  }
  double operator()(const CallNode& call) const {
    double count = 1;
    for (const NodePtr& argument : call.arguments) count += (*this)(argument);
    return count;
  }
  double operator()(const SumNode& sum) const { return (*this)(sum.body); }
};

}  // namespace

double written_out_operations(const NodePtr& node,
                              const std::map<std::string, double>& definitions) {
  return Counter{definitions}(node);
}

}  // namespace hamgen
