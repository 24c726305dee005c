#include "app/studies/ball_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/language/scene.hpp"

namespace hamgen::app {
namespace {

void collect_functions(const NodePtr& node, std::set<std::string>& names) {
  if (const auto* negate = std::get_if<NegateNode>(&node->value)) {
    collect_functions(negate->operand, names);
  } else if (const auto* binary = std::get_if<BinaryNode>(&node->value)) {
    collect_functions(binary->left, names);
    collect_functions(binary->right, names);
  } else if (const auto* call = std::get_if<CallNode>(&node->value)) {
    names.insert(call->function);
    for (const NodePtr& argument : call->arguments) collect_functions(argument, names);
  } else if (const auto* sum = std::get_if<SumNode>(&node->value)) {
    collect_functions(sum->body, names);
  }
}

}  // namespace

BallModel::BallModel(const Model& model, std::map<std::string, Ball> parameters, long bits)
    : model_(model), parameters_(std::move(parameters)), bits_(bits) {
  int first = 0;
  for (const auto* group : {&model.coordinates, &model.momenta}) {
    for (const Variable& variable : *group) {
      variables_[variable.name] = {&variable, first};
      first += variable.range ? static_cast<int>(variable.range->size()) : 1;
    }
  }
  for (const Size& size : model.sizes) sizes_[size.name] = size.value;
}

std::string function_without_derivatives(const Model& model) {
  std::set<std::string> names;
  collect_functions(model.hamiltonian, names);
  for (const Definition& definition : model.definitions) collect_functions(definition.value, names);
  const auto unknown = std::ranges::find_if_not(names, has_ball_derivatives);
  return unknown == names.end() ? "" : *unknown;
}

// At one state.
class BallModel::Evaluation {
 public:
  Evaluation(const BallModel& model, std::span<const Ball> z, bool second)
      : model_(model), z_(z), second_(second) {}

  BallJet value(const NodePtr& node) {
    return std::visit([&](const auto& each) { return of(each); }, node->value);
  }
  [[nodiscard]] BallJet variable(int i) const {
    return {z_[static_cast<std::size_t>(i)], i, second_};
  }

 private:
  BallJet of(const NumberNode& number) { return BallJet(Ball(number.value, model_.bits_)); }
  BallJet of(const NegateNode& negate) { return -value(negate.operand); }
  BallJet of(const BinaryNode& binary) {
    const BallJet left = value(binary.left);
    const BallJet right = value(binary.right);
    switch (binary.operation) {
      case BinaryOperator::add:
        return left + right;
      case BinaryOperator::subtract:
        return left - right;
      case BinaryOperator::multiply:
        return left * right;
      case BinaryOperator::divide:
        return left / right;
      case BinaryOperator::power:
        return power(left, right);
    }
    internal_error("unknown operator");
  }
  BallJet of(const CallNode& call) {
    std::vector<BallJet> arguments;
    for (const NodePtr& argument : call.arguments) arguments.push_back(value(argument));
    return apply_function(call.function, arguments);
  }
  BallJet of(const SumNode& sum) { return sum_over(sum, 0); }
  BallJet sum_over(const SumNode& sum, std::size_t depth) {
    if (depth == sum.ranges.size()) return value(sum.body);
    const SumRange& range = sum.ranges[depth];
    const long lower = integer(range.lower);
    const long upper = integer(range.upper);
    BallJet total;
    for (long i = lower; i <= upper; ++i) {
      indices_[range.index] = i;
      const BallJet term = sum_over(sum, depth + 1);
      total.value += term.value;
      total.second = second_;
      for (const auto& [place, entry] : term.gradient) total.gradient[place] += entry;
      for (const auto& [place, entry] : term.hessian) total.hessian[place] += entry;
    }
    indices_.erase(range.index);
    return total;
  }

  BallJet of(const NameNode& name) {
    if (name.name == "pi" && !name.subscript) return BallJet(Ball::pi(model_.bits_));
    if (const auto it = indices_.find(name.name); it != indices_.end())
      return BallJet(Ball(it->second));
    if (const auto it = model_.variables_.find(name.name); it != model_.variables_.end()) {
      const auto& [declared, first] = it->second;
      return declared->range ? element(*declared, first, integer(name.subscript)) : variable(first);
    }
    if (const auto it = model_.sizes_.find(name.name); it != model_.sizes_.end())
      return BallJet(Ball(it->second, model_.bits_));
    const std::string element =
        name.subscript ? fmt::format("{}[{}]", name.name, integer(name.subscript)) : name.name;
    if (const auto it = model_.parameters_.find(element); it != model_.parameters_.end())
      return BallJet(it->second);
    return definition(name.name);
  }

  BallJet element(const Variable& array, int first, long index) {
    const IndexRange& range = *array.range;
    if (array.periodic)
      index = range.first + ((index - range.first) % range.size() + range.size()) % range.size();
    const bool inside = index >= range.first && index <= range.last;
    if (inside) return variable(first + static_cast<int>(index - range.first));
    return constant_outside_sums(array.beyond.at(index));
  }

  BallJet definition(const std::string& name) {
    if (const auto it = definitions_.find(name); it != definitions_.end()) return it->second;
    const auto& all = model_.model_.definitions;
    const auto it = std::ranges::find(all, name, &Definition::name);
    if (it == all.end()) internal_error("a name without a value in balls: " + name);
    return definitions_.emplace(name, constant_outside_sums(it->value)).first->second;
  }

  // What is written outside the sums knows none of their indices.
  BallJet constant_outside_sums(const NodePtr& node) {
    std::map<std::string, long> inside;
    std::swap(inside, indices_);
    BallJet result = value(node);
    std::swap(inside, indices_);
    return result;
  }

  long integer(const NodePtr& node) const {
    if (const auto* name = std::get_if<NameNode>(&node->value)) {
      if (const auto it = indices_.find(name->name); it != indices_.end()) return it->second;
    }
    std::map<std::string, Rational> values = model_.sizes_;
    for (const auto& [name, index] : indices_) values[name] = index;
    return evaluate_constant(node, model_.model_.source, values).get_num().get_si();
  }

  const BallModel& model_;
  std::span<const Ball> z_;
  bool second_;
  std::map<std::string, long> indices_;
  std::map<std::string, BallJet> definitions_;
};

BallJet BallModel::value(const NodePtr& node, std::span<const Ball> z, bool second) const {
  return Evaluation(*this, z, second).value(node);
}

BallJet BallModel::hamiltonian(std::span<const Ball> z, bool second) const {
  Evaluation evaluation(*this, z, second);
  BallJet energy = evaluation.value(model_.hamiltonian);
  for (const Variable& momentum : model_.momenta) {
    // Of the coordinate t that `time t` declares: H + p_t.
    if (momentum.is_time) energy = energy + evaluation.variable(variables_.at(momentum.name).first);
  }
  return energy;
}

}  // namespace hamgen::app
