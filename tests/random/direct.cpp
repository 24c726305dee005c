#include "tests/random/direct.hpp"

#include <fmt/format.h>
#include <quadmath.h>

#include <stdexcept>

namespace hamgen::random {

Quad to_quad(const Rational& value) {
  // Of 60 digits, which strtoflt128 rounds.
  const bool negative = value < 0;
  const Rational size = negative ? Rational(-value) : value;
  if (size == 0) return 0;
  Rational scaled = size;
  int exponent = 0;
  const Rational least(mpz_class("1" + std::string(60, '0')));
  for (; scaled < least; --exponent) scaled *= 10;
  for (; scaled >= least * 10; ++exponent) scaled /= 10;
  const mpz_class digits = scaled.get_num() / scaled.get_den();
  const std::string text = fmt::format("{}e{}", digits.get_str(), exponent);
  const Quad result = strtoflt128(text.c_str(), nullptr);
  return negative ? -result : result;
}

class DirectModel::Evaluation {
 public:
  Evaluation(const DirectModel& direct, const Vector& z) : direct_(direct), z_(z) {}

  Jet of(const NodePtr& node) {
    return std::visit([&](const auto& each) { return value(each); }, node->value);
  }

 private:
  const Model& model() const { return direct_.model_; }

  Jet value(const NumberNode& number) { return {to_quad(number.value)}; }
  Jet value(const NegateNode& negate) { return Jet{0} - of(negate.operand); }
  Jet value(const CallNode& call) {
    std::vector<Jet> arguments;
    for (const NodePtr& each : call.arguments) arguments.push_back(of(each));
    return apply_function(call.function, arguments);
  }
  Jet value(const BinaryNode& binary) {
    const Jet left = of(binary.left);
    const Jet right = of(binary.right);
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
    throw std::logic_error("unknown operator");
  }
  Jet value(const SumNode& sum) { return over(sum, 0); }
  Jet over(const SumNode& sum, std::size_t range) {
    if (range == sum.ranges.size()) return of(sum.body);
    const SumRange& r = sum.ranges[range];
    Jet total;
    const long upper = integer(r.upper);
    for (long i = integer(r.lower); i <= upper; ++i) {
      indices_[r.index] = i;
      total = total + over(sum, range + 1);
    }
    indices_.erase(r.index);
    return total;
  }
  long integer(const NodePtr& node) { return lrintq(of(node).value); }

  Jet value(const NameNode& name) {
    if (const auto index = indices_.find(name.name); index != indices_.end()) {
      return {Quad(index->second)};
    }
    if (name.name == "pi") return {acosq(-1)};
    for (const Size& each : model().sizes) {
      if (each.name == name.name) return {Quad(each.value)};
    }
    for (const Definition& each : model().definitions) {
      if (each.name != name.name) continue;
      return Evaluation(direct_, z_).of(each.value);  // knows nothing of the indices here
    }
    const auto at = name.subscript ? std::optional(integer(name.subscript)) : std::nullopt;
    std::size_t first = 0;
    for (const auto* variables : {&model().coordinates, &model().momenta}) {
      for (const Variable& each : *variables) {
        if (each.name == name.name) return element(each, first, at);
        first += each.range ? static_cast<std::size_t>(each.range->size()) : 1;
      }
    }
    return {direct_.parameter(at ? fmt::format("{}[{}]", name.name, *at) : name.name)};
  }

  Jet element(const Variable& variable, std::size_t first, std::optional<long> at) {
    if (!variable.range) return coordinate(first);
    if (const auto beyond = variable.beyond.find(*at); beyond != variable.beyond.end()) {
      return of(beyond->second);
    }
    const long size = variable.range->size();
    long i = *at - variable.range->first;
    if (variable.periodic) i = ((i % size) + size) % size;
    if (i < 0 || i >= size) throw std::out_of_range(variable.name);
    return coordinate(first + static_cast<std::size_t>(i));
  }
  Jet coordinate(std::size_t k) {
    Jet result{z_.at(k), Vector(z_.size())};
    result.gradient[k] = 1;
    return result;
  }

  const DirectModel& direct_;
  const Vector& z_;
  std::map<std::string, long> indices_;
};

DirectModel::DirectModel(const Model& model, const std::vector<Rational>& parameters)
    : model_(model), n_(static_cast<std::size_t>(hamgen::degrees_of_freedom(model))) {
  const std::vector<std::string> names = element_names(model.parameters);
  for (std::size_t i = 0; i < names.size(); ++i) parameters_[names[i]] = to_quad(parameters.at(i));
}

Jet DirectModel::value(const NodePtr& node, const Vector& z) const {
  Jet result = Evaluation(*this, z).of(node);
  result.gradient.resize(z.size());
  return result;
}

Jet DirectModel::hamiltonian(const Vector& z) const {
  Jet result = value(model_.hamiltonian, z);
  std::size_t k = n_;
  for (const Variable& each : model_.momenta) {
    if (each.is_time) {
      result.value += z.at(k);
      result.gradient[k] += 1;
    }
    k += each.range ? static_cast<std::size_t>(each.range->size()) : 1;
  }
  return result;
}

}  // namespace hamgen::random
