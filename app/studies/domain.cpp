#include "app/studies/domain.hpp"

#include <set>
#include <string>

#include "generator/algebra/functions.hpp"

namespace hamgen::app {
namespace {

class Walk {
 public:
  explicit Walk(const Model& model) {
    for (const auto* variables : {&model.coordinates, &model.momenta}) {
      for (const Variable& each : *variables) {
        state_.insert(each.name);
        for (const auto& beyond : each.beyond) defined_ &= visit(beyond.second).defined;
      }
    }
    for (const Definition& each : model.definitions) {
      const Part part = visit(each.value);
      if (part.of_state) state_.insert(each.name);
      defined_ &= part.defined;
    }
    defined_ &= visit(model.hamiltonian).defined;
  }

  [[nodiscard]] bool defined() const { return defined_; }

 private:
  struct Part {
    bool of_state = false;  // contains a coordinate or a momentum
    bool defined = true;    // for every state, if its constants are
  };

  [[nodiscard]] static Part both(const Part& a, const Part& b) {
    return {a.of_state || b.of_state, a.defined && b.defined};
  }

  [[nodiscard]] Part visit(const NodePtr& node) const {
    return std::visit([this](const auto& value) { return part_of(value); }, node->value);
  }

  [[nodiscard]] static Part part_of(const NumberNode& /*node*/) { return {}; }
  [[nodiscard]] Part part_of(const NameNode& node) const { return {state_.contains(node.name)}; }
  [[nodiscard]] Part part_of(const NegateNode& node) const { return visit(node.operand); }
  [[nodiscard]] Part part_of(const SumNode& node) const { return visit(node.body); }

  [[nodiscard]] Part part_of(const CallNode& node) const {
    Part part;
    for (const NodePtr& argument : node.arguments) part = both(part, visit(argument));
    const Function* row = find_function(node.function);
    if (part.of_state) part.defined &= row != nullptr && row->is_smooth;
    return part;
  }

  [[nodiscard]] Part part_of(const BinaryNode& node) const {
    const Part left = visit(node.left);
    const Part right = visit(node.right);
    Part part = both(left, right);
    if (node.operation == BinaryOperator::divide) part.defined &= !right.of_state;
    if (node.operation == BinaryOperator::power && part.of_state) {
      const auto* exponent = std::get_if<NumberNode>(&node.right->value);
      part.defined &= exponent != nullptr && exponent->value >= 0 && exponent->value.get_den() == 1;
    }
    return part;
  }

  std::set<std::string> state_;
  bool defined_ = true;
};

}  // namespace

bool is_defined_everywhere(const Model& model) { return Walk(model).defined(); }

}  // namespace hamgen::app
