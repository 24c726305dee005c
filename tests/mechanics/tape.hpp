// Expressions evaluated in long double, without emitted code.
#pragma once

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen::mechanics_test {

using Vector = std::vector<long double>;

inline long double number(const Rational& value) {
  const TripleDouble parts = to_triple(value);
  return static_cast<long double>(parts.hi) + parts.lo + parts.lower;
}

// The values as functions of the inputs; each shared node is evaluated once.
class Tape {
 public:
  Tape(const std::vector<Expression>& values, const std::vector<std::string>& inputs) {
    for (const std::string& input : inputs) places_[input] = operations_.size(), add({}, {});
    inputs_ = inputs.size();
    for (const Expression& value : values) results_.push_back(visit(value));
  }

  [[nodiscard]] Vector operator()(const Vector& inputs) const {
    Vector x(operations_.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = i < inputs_ ? inputs.at(i) : evaluate(operations_[i], x);
    }
    Vector results;
    for (const std::size_t place : results_) results.push_back(x[place]);
    return results;
  }

 private:
  struct Operation {
    Expression node;
    std::vector<std::size_t> operands;
    long double constant = 0;
  };

  std::size_t add(const Expression& node, std::vector<std::size_t> operands) {
    operations_.push_back(
        {node, std::move(operands), node.is_number() ? number(node.number()) : 0});
    return operations_.size() - 1;
  }

  std::size_t visit(const Expression& node) {
    if (node.kind() == Kind::symbol) return places_.at(node.name());
    if (const auto it = known_.find(node); it != known_.end()) return it->second;
    std::vector<std::size_t> operands;
    for (const Expression& operand : node.operands()) operands.push_back(visit(operand));
    return known_[node] = add(node, std::move(operands));
  }

  static long double evaluate(const Operation& operation, const Vector& x) {
    const auto value = [&](std::size_t i) { return x[operation.operands[i]]; };
    long double result = 0;
    switch (operation.node.kind()) {
      case Kind::number:
        return operation.constant;
      case Kind::symbol:
        break;
      case Kind::sum:
        for (const std::size_t i : operation.operands) result += x[i];
        return result;
      case Kind::product:
        result = 1;
        for (const std::size_t i : operation.operands) result *= x[i];
        return result;
      case Kind::power:
        return std::pow(value(0), value(1));
      case Kind::function:
        if (operation.node.name() == "sin") return std::sin(value(0));
        if (operation.node.name() == "cos") return std::cos(value(0));
        if (operation.node.name() == "exp") return std::exp(value(0));
        if (operation.node.name() == "log") return std::log(value(0));
        if (operation.node.name() == "tanh") return std::tanh(value(0));
        if (operation.node.name() == "atan") return std::atan(value(0));
        if (operation.node.name() == "atan2") return std::atan2(value(0), value(1));
        break;
    }
    throw std::logic_error("the tape does not know " + to_text(operation.node));
  }

  std::vector<Operation> operations_;
  std::map<std::string, std::size_t> places_;
  ExpressionMap<std::size_t> known_;
  std::size_t inputs_ = 0;
  std::vector<std::size_t> results_;
};

}  // namespace hamgen::mechanics_test
