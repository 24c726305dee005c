// Parameters with structural values, put into the model.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "generator/language/constant.hpp"
#include "generator/specialise/specialisation.hpp"

namespace hamgen {

namespace {

// The tree with every name replaced for which `renamed` has another node.
using Rename = std::function<NodePtr(const Node&, const NameNode&)>;
NodePtr rewritten(const NodePtr& node, const Rename& renamed) {
  const auto again = [&renamed](const NodePtr& child) {
    return child ? rewritten(child, renamed) : child;
  };
  Node result = *node;
  if (auto* name = std::get_if<NameNode>(&result.value)) {
    if (NodePtr other = renamed(*node, *name)) return other;
    name->subscript = again(name->subscript);
  } else if (auto* negate = std::get_if<NegateNode>(&result.value)) {
    negate->operand = again(negate->operand);
  } else if (auto* binary = std::get_if<BinaryNode>(&result.value)) {
    binary->left = again(binary->left);
    binary->right = again(binary->right);
  } else if (auto* call = std::get_if<CallNode>(&result.value)) {
    for (NodePtr& argument : call->arguments) argument = again(argument);
  } else if (auto* sum = std::get_if<SumNode>(&result.value)) {
    for (SumRange& range : sum->ranges) {
      range.lower = again(range.lower);
      range.upper = again(range.upper);
    }
    sum->body = again(sum->body);
  }
  return std::make_shared<const Node>(std::move(result));
}

void visit_nodes(const NodePtr& node, const std::function<void(const NodePtr&)>& use) {
  if (!node) return;
  use(node);
  if (const auto* name = std::get_if<NameNode>(&node->value)) {
    visit_nodes(name->subscript, use);
  } else if (const auto* negate = std::get_if<NegateNode>(&node->value)) {
    visit_nodes(negate->operand, use);
  } else if (const auto* binary = std::get_if<BinaryNode>(&node->value)) {
    visit_nodes(binary->left, use);
    visit_nodes(binary->right, use);
  } else if (const auto* call = std::get_if<CallNode>(&node->value)) {
    for (const NodePtr& argument : call->arguments) visit_nodes(argument, use);
  } else if (const auto* sum = std::get_if<SumNode>(&node->value)) {
    visit_nodes(sum->body, use);
  }
}

// Every formula of the step: H, invariants, definitions, values beyond the ends of arrays.
void visit_formulas(Model& model, const std::function<void(NodePtr&)>& use) {
  use(model.hamiltonian);
  for (Definition& each : model.definitions) use(each.value);
  for (Invariant& each : model.invariants) use(each.value);
  for (auto* variables : {&model.coordinates, &model.momenta}) {
    for (Variable& each : *variables) {
      for (auto& [at, value] : each.beyond) use(value);
    }
  }
}

class Folder {
 public:
  Folder(const Model& model, const SceneFacts& scene, const std::vector<std::string>& burnt)
      : scene_(scene), burnt_(burnt.begin(), burnt.end()), result_{.model = model, .folding = {}} {
    const std::vector<std::string> names = element_names(model.parameters);
    // Parameters of the scheme, behind the model's, have no value in the scene.
    for (std::size_t i = 0; i < std::min(names.size(), scene.values.parameters.size()); ++i)
      values_[names[i]] = scene.values.parameters[i];
    where_ = scene.values.name.empty() ? "here" : "in scene " + scene.values.name;
  }

  FoldedModel run() {
    find_used();
    find_exponents();
    make_defaults_numbers();
    for (Parameter& parameter : result_.model.parameters) {
      if (parameter.range) make_one_number(parameter);
      fold(parameter);
    }
    while (unite_one_pair()) {
    }
    return std::move(result_);
  }

 private:
  std::vector<std::string> elements(const Parameter& parameter) const {
    return element_names(std::vector{parameter});
  }
  bool is_kept(const Parameter& parameter) const {
    if (scene_.kept.contains(parameter.name)) return true;
    if (!values_.contains(elements(parameter).front())) return true;
    return std::ranges::any_of(elements(parameter), [this](const std::string& name) {
      return scene_.kept.contains(name);
    });
  }
  void say(const std::string& line) { result_.folding.left_out.push_back(line); }

  void find_used() {
    visit_formulas(result_.model, [this](const NodePtr& formula) {
      visit_nodes(formula, [this](const NodePtr& node) {
        if (const auto* name = std::get_if<NameNode>(&node->value)) used_.insert(name->name);
      });
    });
  }

  // Names below an exponent, through definitions.
  void find_exponents() {
    const auto add = [this](const NodePtr& exponent) {
      visit_nodes(exponent, [this](const NodePtr& node) {
        if (const auto* name = std::get_if<NameNode>(&node->value))
          in_exponents_.insert(name->name);
      });
    };
    visit_formulas(result_.model, [&add](const NodePtr& formula) {
      visit_nodes(formula, [&add](const NodePtr& node) {
        const auto* binary = std::get_if<BinaryNode>(&node->value);
        if (binary != nullptr && binary->operation == BinaryOperator::power) add(binary->right);
      });
    });
    for (auto each = result_.model.definitions.rbegin(); each != result_.model.definitions.rend();
         ++each) {
      if (in_exponents_.contains(each->name)) add(each->value);
    }
  }

  // Defaults that are computed from others must not change with those.
  void make_defaults_numbers() {
    std::map<std::string, Rational> known;
    for (Parameter& parameter : result_.model.parameters) {
      const std::vector<std::string> names = elements(parameter);
      std::vector<NodePtr> numbers;
      for (std::size_t i = 0; i < names.size(); ++i) {
        const NodePtr& node = parameter.values[std::min(i, parameter.values.size() - 1)];
        known[names[i]] = evaluate_constant(node, result_.model.source, known);
        numbers.push_back(
            std::make_shared<const Node>(Node{node->span, NumberNode{known[names[i]]}}));
      }
      parameter.values = std::move(numbers);
    }
  }

  // m[1..3], all of one value, becomes m.
  void make_one_number(Parameter& parameter) {
    if (is_kept(parameter) || !used_.contains(parameter.name)) return;
    const std::vector<std::string> names = elements(parameter);
    const Rational value = values_.at(names.front());
    const bool equal = std::ranges::all_of(
        names, [&](const std::string& name) { return values_.at(name) == value; });
    if (!equal || names.size() < 2) return;
    say(fmt::format("{}[{}..{}] as an array: all entries are equal {}", parameter.name,
                    parameter.range->first, parameter.range->last, where_));
    for (const std::string& name : names) result_.folding.same.emplace_back(name, parameter.name);
    parameter.range.reset();
    parameter.values.resize(1);
    values_[parameter.name] = value;
    visit_formulas(result_.model, [&](NodePtr& formula) {
      formula = rewritten(formula, [&](const Node& node, const NameNode& name) -> NodePtr {
        if (name.name != parameter.name) return nullptr;
        return std::make_shared<const Node>(Node{node.span, NameNode{name.name, nullptr}});
      });
    });
  }

  bool is_structural(const Parameter& parameter, const Rational& value) const {
    if (value == 0 || value == 1 || value == -1) return true;
    const bool halves = value.get_den() <= 2 && abs(value) <= 64;
    return halves && in_exponents_.contains(parameter.name);
  }

  void fold(Parameter& parameter) {
    const bool burnt = burnt_.contains(parameter.name);
    if (!burnt && (is_kept(parameter) || !used_.contains(parameter.name))) return;
    const std::vector<std::string> names = elements(parameter);
    const bool structural = std::ranges::all_of(
        names, [&](const std::string& name) { return is_structural(parameter, values_.at(name)); });
    if (!burnt && !structural) return;
    parameter.folded = true;
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Rational& value = values_.at(names[i]);
      parameter.values[i] =
          std::make_shared<const Node>(Node{parameter.values[i]->span, NumberNode{value}});
      result_.folding.values.push_back({names[i], value});
      texts.push_back(short_text(value));
    }
    say(fmt::format("parameter {}: {} {}", parameter.name, fmt::join(texts, ", "), where_));
  }

  bool is_single(const Parameter& parameter) const {
    return !parameter.range && !parameter.folded && !is_kept(parameter) &&
           used_.contains(parameter.name);
  }

  static NodePtr with_name(const NodePtr& formula, const std::string& from, const std::string& to) {
    return rewritten(formula, [&](const Node& node, const NameNode& name) -> NodePtr {
      if (name.name != from) return nullptr;
      return std::make_shared<const Node>(Node{node.span, NameNode{to, nullptr}});
    });
  }

  // How many differences of the formulas are between a thing and itself.
  static long empty_differences(Model& model) {
    long count = 0;
    visit_formulas(model, [&count](const NodePtr& formula) {
      visit_nodes(formula, [&count](const NodePtr& node) {
        const auto* binary = std::get_if<BinaryNode>(&node->value);
        if (binary == nullptr || binary->operation != BinaryOperator::subtract) return;
        if (to_text(binary->left) == to_text(binary->right)) ++count;
      });
    });
    return count;
  }

  // k2 becomes k1 where both have one value and k1 - k2 stands in a formula.
  bool unite_one_pair() {
    const std::vector<Parameter>& all = result_.model.parameters;
    for (std::size_t j = 1; j < all.size(); ++j) {
      for (std::size_t i = 0; i < j; ++i) {
        if (!is_single(all[i]) || !is_single(all[j])) continue;
        if (values_.at(all[i].name) != values_.at(all[j].name)) continue;
        Model united = result_.model;
        visit_formulas(united, [&](NodePtr& formula) {
          formula = with_name(formula, all[j].name, all[i].name);
        });
        if (empty_differences(united) == empty_differences(result_.model)) continue;
        say(fmt::format("parameter {}: equal to {} {}", all[j].name, all[i].name, where_));
        used_.erase(all[j].name);
        result_.folding.same.emplace_back(all[j].name, all[i].name);
        result_.model = std::move(united);
        return true;
      }
    }
    return false;
  }

  const SceneFacts& scene_;
  std::set<std::string> burnt_;
  FoldedModel result_;
  std::map<std::string, Rational> values_;
  std::set<std::string> used_, in_exponents_;
  std::string where_;
};

}  // namespace

FoldedModel fold(const Model& model, const SceneFacts& scene,
                 const std::vector<std::string>& burnt) {
  return Folder(model, scene, burnt).run();
}

}  // namespace hamgen
