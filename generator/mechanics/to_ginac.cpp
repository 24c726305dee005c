#include "generator/mechanics/to_ginac.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "generator/algebra/evaluate.hpp"
#include "generator/algebra/ginac_functions.hpp"
#include "generator/algebra/ginac_parts.hpp"
#include "generator/base/budget.hpp"
#include "generator/language/scene.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

std::string_view reason_of(const std::exception& error) {
  std::string_view text = error.what();
  const std::size_t name = text.find("(): ");
  if (name != text.npos) text.remove_prefix(name + 4);
  return text;
}

namespace {

constexpr double bits_of_digits = 3.33;  // log2(10), rounded up

bool is_constant(const GiNaC::ex& e) {
  spend(Resource::work, 1);
  if (GiNaC::is_a<GiNaC::symbol>(e)) return false;
  return std::ranges::all_of(operands_of(e), is_constant);
}

}  // namespace

std::string element_name(const std::string& name, long index) {
  return fmt::format("{}[{}]", name, index);
}

TreeConverter::TreeConverter(const Model& model, SymbolTable& table)
    : model_(model), table_(table) {
  int rank = kRankOfVariable;
  for (const auto* group : {&model.coordinates, &model.momenta}) {
    for (const Variable& variable : *group) {
      variables_[variable.name] = {&variable, rank};
      rank += variable.range ? static_cast<int>(variable.range->size()) : 1;
    }
  }
  rank = kRankOfParameter;
  // Of all parameters so far, for the folded ones.
  std::map<std::string, Rational> values = numbers_of_sizes(model);
  const bool is_any_folded = std::ranges::any_of(model.parameters, &Parameter::folded);
  for (const Parameter& parameter : model.parameters) {
    parameters_[parameter.name] = {&parameter, rank};
    const long count = parameter.range ? parameter.range->size() : 1;
    rank += static_cast<int>(count);
    for (long k = 0; is_any_folded && k < count; ++k) {
      const std::string name = parameter.range
                                   ? element_name(parameter.name, parameter.range->first + k)
                                   : parameter.name;
      const auto place =
          std::min<std::size_t>(static_cast<std::size_t>(k), parameter.values.size() - 1);
      values[name] = evaluate_constant(parameter.values[place], model.source, values);
      if (parameter.folded) folded_[name] = values[name];
    }
  }
}

void TreeConverter::fail(const Span& span, std::string message, std::string help) const {
  throw ModelError({Diagnostic{Severity::error, span, std::move(message), std::move(help)}},
                   model_.source);
}

GiNaC::ex TreeConverter::convert(const NodePtr& node) {
  try {
    return convert(node, {});
  } catch (const OverBudget& error) {
    throw over_budget(error, node->span, model_.source);
  }
}

GiNaC::ex TreeConverter::convert(const NodePtr& node, const Indices& indices) {
  spend(Resource::work, 1);
  try {
    if (const auto* number = std::get_if<NumberNode>(&node->value)) {
      return to_ginac(number->value);
    }
    if (const auto* name = std::get_if<NameNode>(&node->value)) {
      return convert_name(*name, node->span, indices);
    }
    if (const auto* negate = std::get_if<NegateNode>(&node->value)) {
      return -convert(negate->operand, indices);
    }
    if (const auto* binary = std::get_if<BinaryNode>(&node->value)) {
      return convert_binary(*node, *binary, indices);
    }
    if (const auto* call = std::get_if<CallNode>(&node->value)) {
      GiNaC::exvector arguments;
      for (const NodePtr& argument : call->arguments) {
        arguments.push_back(convert(argument, indices));
      }
      require_real(*node, arguments, [&](std::span<const Rational> values) {
        return call_function(call->function, values);
      });
      return ginac_function(call->function, arguments);
    }
    const auto& sum = std::get<SumNode>(node->value);
    if (sum_) {
      if (const auto value = sum_(sum)) return *value;
    }
    return convert_sum(sum, 0, indices);
  } catch (const ModelError&) {
    throw;
  } catch (const OverBudget&) {
    throw;
  } catch (const GiNaC::pole_error&) {
    fail(node->span, "division by zero", "this is undefined for every state");
  } catch (const std::exception& error) {
    fail(node->span, fmt::format("undefined or not real: {}", reason_of(error)));
  }
}

GiNaC::ex TreeConverter::convert_name(const NameNode& name, const Span& span,
                                      const Indices& indices) {
  if (name.name == "pi" && !name.subscript) return GiNaC::Pi;
  if (const auto it = indices.find(name.name); it != indices.end()) return it->second;
  if (symbolic_indices_.contains(name.name)) return table_.symbol(name.name, kRankOfParameter);
  if (element_) {
    if (const auto value = element_(name)) return *value;
  }
  if (const auto it = variables_.find(name.name); it != variables_.end()) {
    const auto& [variable, rank] = it->second;
    if (!variable->range) return table_.symbol(name.name, rank);
    return element(*variable, integer(name.subscript, indices), span);
  }
  if (const auto it = parameters_.find(name.name); it != parameters_.end()) {
    const auto& [parameter, rank] = it->second;
    std::string element = name.name;
    int place = rank;
    if (parameter->range) {
      const long index = integer(name.subscript, indices);
      if (index < parameter->range->first || index > parameter->range->last) {
        fail(span, fmt::format("{}[{}] does not exist", name.name, index));
      }
      element = element_name(name.name, index);
      place += static_cast<int>(index - parameter->range->first);
    }
    if (parameter->folded) return to_ginac(folded_.at(element));
    return table_.symbol(element, place);
  }
  for (const Size& size : model_.sizes) {
    if (size.name == name.name) return size.number;
  }
  for (const Definition& definition : model_.definitions) {
    if (definition.name != name.name) continue;
    if (const auto it = definitions_.find(name.name); it != definitions_.end()) return it->second;
    const GiNaC::ex value = convert(definition.value);
    definitions_.emplace(name.name, value);
    return value;
  }
  if (name.name == "h" || name.name == "E0") return table_.symbol(name.name, kRankOfStep);
  internal_error("unchecked name " + name.name);
}

GiNaC::ex TreeConverter::element(const Variable& variable, long index, const Span& span) {
  const IndexRange& range = *variable.range;
  if (variable.periodic) {
    const long offset = ((index - range.first) % range.size() + range.size()) % range.size();
    index = range.first + offset;
  }
  if (index < range.first || index > range.last) {
    const auto it = variable.beyond.find(index);
    if (it == variable.beyond.end()) {
      fail(span, fmt::format("{}[{}] does not exist", variable.name, index),
           fmt::format("the array is {}[{}..{}]", variable.name, range.first, range.last));
    }
    return convert(it->second, {});
  }
  const int rank = variables_.at(variable.name).second + static_cast<int>(index - range.first);
  return table_.symbol(element_name(variable.name, index), rank);
}

// A function or a power of constants has a real value, or the model a mistake: they may have become
// constants by cancelling only, as in acosh(q - q).
void TreeConverter::require_real(const Node& node, const GiNaC::exvector& operands,
                                 const ConstantFunction& function) const {
  std::vector<Rational> values;
  for (const GiNaC::ex& operand : operands) {
    if (!is_constant(operand)) return;
    const std::optional<Rational> value = evaluate(from_ginac(operand, table_), {});
    if (!value) return;  // undefined in itself, which was said
    values.push_back(*value);
  }
  const Constant result = function(values);
  if (const auto* mistake = std::get_if<Undefined>(&result))
    fail(node.span, mistake->message, mistake->help);
}

GiNaC::ex TreeConverter::convert_binary(const Node& place, const BinaryNode& node,
                                        const Indices& indices) {
  const GiNaC::ex left = convert(node.left, indices);
  const GiNaC::ex right = convert(node.right, indices);
  switch (node.operation) {
    case BinaryOperator::add:
      return moderate(place.span, left + right);
    case BinaryOperator::subtract:
      return moderate(place.span, left - right);
    case BinaryOperator::multiply:
      return moderate(place.span, left * right);
    case BinaryOperator::divide:
      if (vanishes_when_expanded(right)) fail(node.right->span, "division by zero");
      return moderate(place.span, left / right);
    case BinaryOperator::power: {
      const bool negative =
          GiNaC::is_a<GiNaC::numeric>(right) && right.info(GiNaC::info_flags::negative);
      if ((negative || right.is_zero()) && vanishes_when_expanded(left)) {
        fail(node.left->span, negative ? "division by zero" : "0^0 is undefined");
      }
      if (!right.info(GiNaC::info_flags::integer)) {
        require_real(place, {left, right}, [](std::span<const Rational> values) {
          return combine(BinaryOperator::power, values[0], values[1]);
        });
      }
      require_moderate_power(place, left, right);
      return moderate(place.span, GiNaC::pow(left, right));
    }
  }
  internal_error("unknown operator");
}

long TreeConverter::integer(const NodePtr& node, const Indices& indices) const {
  std::map<std::string, Rational> values;
  for (const Size& size : model_.sizes) values[size.name] = size.value;
  for (const auto& [name, value] : indices) values[name] = value;
  const Rational value = evaluate_constant(node, model_.source, values);
  if (value.get_den() != 1 || !value.get_num().fits_slong_p()) {
    fail(node->span, "a subscript must be an integer");
  }
  return value.get_num().get_si();
}

// The value, if its coefficients are of moderate length: 1/1 + 1/2 + ... + 1/n has about n digits.
GiNaC::ex TreeConverter::moderate(const Span& span, const GiNaC::ex& value) const {
  if (longest_coefficient(value) > bits_of_digits * most_digits) {
    const Undefined mistake = too_long();
    fail(span, mistake.message, mistake.help);
  }
  return value;
}

// (c x)^n is c^n x^n.
void TreeConverter::require_moderate_power(const Node& place, const GiNaC::ex& base,
                                           const GiNaC::ex& exponent) const {
  if (GiNaC::is_a<GiNaC::add>(base) || !exponent.info(GiNaC::info_flags::integer)) return;
  const double n = std::abs(GiNaC::ex_to<GiNaC::numeric>(exponent).to_double());
  if (longest_coefficient(base) * n <= bits_of_digits * most_digits) return;
  const Undefined mistake = too_long();
  fail(place.span, mistake.message, mistake.help);
}

GiNaC::ex TreeConverter::convert_sum(const SumNode& node, std::size_t depth, Indices indices) {
  if (depth == node.ranges.size()) {
    try {
      spend(Resource::terms, 1);
      return convert(node.body, indices);
    } catch (const OverBudget& error) {
      throw over_budget(error, node.body->span, model_.source);
    }
  }
  const SumRange& range = node.ranges[depth];
  const long first = integer(range.lower, indices);
  const long last = integer(range.upper, indices);
  return first > last ? GiNaC::ex(0) : add_up(node, depth, indices, first, last);
}

// By halves: fractions that are added one by one are reduced a thousand times at full length.
GiNaC::ex TreeConverter::add_up(const SumNode& node, std::size_t depth, Indices& indices,
                                long first, long last) {
  constexpr long few = 32;
  GiNaC::exvector terms;
  if (last - first >= few) {
    const long middle = first + (last - first) / 2;
    terms.push_back(add_up(node, depth, indices, first, middle));
    terms.push_back(add_up(node, depth, indices, middle + 1, last));
  } else {
    for (long i = first; i <= last; ++i) {
      indices[node.ranges[depth].index] = i;
      terms.push_back(convert_sum(node, depth + 1, indices));
    }
  }
  const GiNaC::ex sum = GiNaC::add(terms);
  spend(Resource::nodes, static_cast<double>(sum.nops()));
  return moderate(node.body->span, sum);
}

}  // namespace hamgen
