#include <fmt/format.h>

#include <algorithm>

#include "generator/language/model.hpp"

namespace hamgen {
namespace {

// How tightly an expression holds together.
enum Binding { sum_level = 1, product_level, sign_level, power_level, atom_level };

Binding binding(const Node& node) {
  if (std::holds_alternative<NegateNode>(node.value)) return sign_level;
  if (const auto* number = std::get_if<NumberNode>(&node.value)) {
    return number->value < 0 ? sign_level : atom_level;
  }
  const auto* binary = std::get_if<BinaryNode>(&node.value);
  if (binary == nullptr) return atom_level;
  switch (binary->operation) {
    case BinaryOperator::add:
    case BinaryOperator::subtract:
      return sum_level;
    case BinaryOperator::multiply:
    case BinaryOperator::divide:
      return product_level;
    case BinaryOperator::power:
      return power_level;
  }
  internal_error("unknown operator");
}

// A decimal that reads back exactly; literals are decimals, so there always is one.
std::string decimal(const Rational& value) {
  if (value < 0) return "-" + decimal(-value);
  if (value.get_den() == 1 && value.get_num() < 1'000'000'000'000'000) return to_text(value);
  std::string shortest = shortest_decimal(to_double(value));
  if (parse_decimal(shortest) == value) {
    if (shortest.ends_with(".0")) shortest.resize(shortest.size() - 2);
    return shortest;
  }
  Rational scaled = value;
  for (int digits = 0; digits <= 1500; ++digits, scaled *= 10) {
    if (scaled.get_den() == 1) {
      return digits == 0 ? to_text(scaled) : fmt::format("{}e-{}", to_text(scaled), digits);
    }
  }
  return fmt::format("({})", to_text(value));
}

std::string text_of(const Node&, const NumberNode& number) { return decimal(number.value); }

std::string text_of(const Node&, const NameNode& name) {
  return name.subscript ? fmt::format("{}[{}]", name.name, to_text(name.subscript)) : name.name;
}

std::string at_least(Binding level, const NodePtr& node) {
  return binding(*node) >= level ? to_text(node) : fmt::format("({})", to_text(node));
}

std::string text_of(const Node&, const NegateNode& negate) {
  return "-" + at_least(power_level, negate.operand);
}

// The right operand of + - * / has no sign of its own and binds more tightly than the operator,
// because a - (b - c) and a/(b/c) are not a - b - c and a/b/c.
std::string right_operand(Binding level, const NodePtr& node) {
  const bool sign = binding(*node) == sign_level;
  return sign ? fmt::format("({})", to_text(node)) : at_least(level, node);
}

std::string text_of(const Node&, const BinaryNode& binary) {
  switch (binary.operation) {
    case BinaryOperator::add:
      return to_text(binary.left) + " + " + right_operand(product_level, binary.right);
    case BinaryOperator::subtract:
      return to_text(binary.left) + " - " + right_operand(product_level, binary.right);
    case BinaryOperator::multiply:
      return at_least(product_level, binary.left) + "*" + right_operand(power_level, binary.right);
    case BinaryOperator::divide:
      return at_least(product_level, binary.left) + "/" + right_operand(power_level, binary.right);
    case BinaryOperator::power:
      return at_least(atom_level, binary.left) + "^" + at_least(sign_level, binary.right);
  }
  internal_error("unknown operator");
}

std::string text_of(const Node&, const CallNode& call) {
  std::string list;
  for (const NodePtr& argument : call.arguments) {
    list += (list.empty() ? "" : ", ") + to_text(argument);
  }
  return fmt::format("{}({})", call.function, list);
}

std::string text_of(const Node&, const SumNode& sum) {
  std::string text = "sum(";
  for (const SumRange& range : sum.ranges) {
    text += fmt::format("{} = {}..{}, ", range.index, to_text(range.lower), to_text(range.upper));
  }
  return text + to_text(sum.body) + ")";
}

std::string range_text(const std::optional<IndexRange>& range) {
  return range ? fmt::format("[{}..{}]", range->first, range->last) : "";
}

std::string unit_text(const std::string& unit) {
  return unit.empty() ? "" : fmt::format(" [{}]", unit);
}

std::string comment_text(const std::string& comment) {
  return comment.empty() ? "" : fmt::format("  # {}", comment);
}

std::string list_text(const std::vector<NodePtr>& values) {
  std::string text;
  for (const NodePtr& value : values) text += (text.empty() ? "" : ", ") + to_text(value);
  return fmt::format("[{}]", text);
}

std::string variable_text(std::string_view keyword, const Variable& variable) {
  std::string text = fmt::format("{} {}{}{}", keyword, variable.name, range_text(variable.range),
                                 unit_text(variable.unit));
  if (variable.periodic) text += " periodic";
  std::string before = " with ";
  for (const auto& [at, value] : variable.beyond) {
    text += fmt::format("{}{}[{}] = {}", before, variable.name, at, to_text(value));
    before = ", ";
  }
  return text + comment_text(variable.comment) + "\n";
}

std::string parameter_text(const Parameter& parameter) {
  const bool same = std::ranges::all_of(
      parameter.values, [&](const NodePtr& each) { return each == parameter.values.front(); });
  const bool list = parameter.range && !(same && parameter.values.size() > 1);
  return fmt::format("parameter {}{} = {}{}{}\n", parameter.name, range_text(parameter.range),
                     list ? list_text(parameter.values) : to_text(parameter.values.front()),
                     unit_text(parameter.unit), comment_text(parameter.comment));
}

std::string setting_text(const Setting& setting) {
  std::string subscript;
  if (!setting.index.empty()) subscript = fmt::format("[{}]", setting.index);
  if (setting.element) subscript = fmt::format("[{}]", to_text(setting.element));
  return fmt::format("  {}{} = {}\n", setting.name, subscript,
                     setting.is_list ? list_text(setting.values) : to_text(setting.values.front()));
}

std::string observed_text(const Observed& observed) {
  if (observed.value) return fmt::format("{} = {}", observed.name, to_text(observed.value));
  if (!observed.element) return observed.name;
  return fmt::format("{}[{}]", observed.name, to_text(observed.element));
}

std::string scene_text(const Scene& scene) {
  std::string text = fmt::format("scene {} {{{}\n", scene.name, comment_text(scene.comment));
  for (const Setting& setting : scene.settings) text += setting_text(setting);
  if (scene.h) text += fmt::format("  h = {}\n", to_text(scene.h));
  if (scene.steps) text += fmt::format("  steps = {}\n", to_text(scene.steps));
  if (scene.every) text += fmt::format("  every = {}\n", to_text(scene.every));
  if (!scene.observe.empty()) {
    std::vector<std::string> items;
    for (const Observed& each : scene.observe) items.push_back(observed_text(each));
    text += fmt::format("  observe {}\n", fmt::join(items, ", "));
  }
  return text + "}\n";
}

template <typename Declared>
std::vector<std::string> names_of_elements(const std::vector<Declared>& declared) {
  std::vector<std::string> names;
  for (const Declared& each : declared) {
    if (!each.range) {
      names.push_back(each.name);
      continue;
    }
    for (long i = each.range->first; i <= each.range->last; ++i) {
      names.push_back(fmt::format("{}[{}]", each.name, i));
    }
  }
  return names;
}

}  // namespace

long degrees_of_freedom(const Model& model) {
  long count = 0;
  for (const Variable& each : model.coordinates) count += each.range ? each.range->size() : 1;
  return count;
}

std::string no_event_text(const Model& model) {
  return fmt::format("{} has no event\nhelp: declare one in the model: event crossing = {} rising",
                     model.name, element_names(model.coordinates).front());
}

std::vector<std::string> element_names(const std::vector<Variable>& variables) {
  return names_of_elements(variables);
}

std::vector<std::string> element_names(const std::vector<Parameter>& parameters) {
  return names_of_elements(parameters);
}

std::string to_text(const NodePtr& node) {
  return std::visit([&](const auto& each) { return text_of(*node, each); }, node->value);
}

std::string to_text(const Model& model) {
  std::string text = fmt::format("system {}\n", model.name);
  for (const Size& each : model.sizes) {
    text += fmt::format("size {} = {}{}\n", each.name, each.value, comment_text(each.comment));
  }
  for (const Variable& each : model.coordinates) {
    text += variable_text(each.is_time ? "time" : "coordinate", each);
  }
  for (const Variable& each : model.momenta) {
    if (!each.is_time) text += variable_text("momentum", each);
  }
  for (const Parameter& each : model.parameters) text += parameter_text(each);
  for (const Definition& each : model.definitions) {
    text += fmt::format("let {} = {}\n", each.name, to_text(each.value));
  }
  text += fmt::format("H = {}\n", to_text(model.hamiltonian));
  for (const Invariant& each : model.invariants) {
    if (each.is_event()) continue;
    text += fmt::format("invariant {} = {}{}\n", each.name, to_text(each.value),
                        comment_text(each.comment));
  }
  for (const ModelEvent& each : model.events) {
    text += fmt::format("event {} = {}{}{}\n", each.name, to_text(each.value),
                        !each.falling  ? " rising"
                        : !each.rising ? " falling"
                                       : "",
                        comment_text(each.comment));
  }
  for (const Scene& each : model.scenes) text += scene_text(each);
  return text;
}

}  // namespace hamgen
