#include "generator/mechanics/split_sums.hpp"

#include <algorithm>
#include <map>

#include "generator/language/scene.hpp"

namespace hamgen {

namespace {

using Indices = std::map<std::string, long>;

long integer(const Model& model, const NodePtr& node, const Indices& indices) {
  std::map<std::string, Rational> values;
  for (const Size& size : model.sizes) values[size.name] = size.value;
  for (const auto& [name, value] : indices) values[name] = value;
  return evaluate_constant(node, model.source, values).get_num().get_si();
}

class SumSplitter {
 public:
  explicit SumSplitter(const Model& model) : model_(model) {}

  std::optional<SplitSums> run(const NodePtr& formula) {
    if (!split(formula, {}, {})) return std::nullopt;
    return SplitSums{std::move(terms_), std::move(functions_)};
  }

  // Does a sum stand there, or in a definition that is named there?
  [[nodiscard]] bool contains_sum(const NodePtr& node) const {
    if (std::holds_alternative<SumNode>(node->value)) return true;
    if (const auto* name = std::get_if<NameNode>(&node->value); name && !name->subscript) {
      const Definition* definition = find_definition(model_, name->name);
      if (definition == nullptr) return false;
      if (const auto known = has_sum_.find(name->name); known != has_sum_.end())
        return known->second;
      return has_sum_[name->name] = contains_sum(definition->value);
    }
    bool found = false;
    for_children(node, [&](const NodePtr& child) { found = found || contains_sum(child); });
    return found;
  }

 private:
  // Splits at plus and minus and at sums.  False if a sum stands inside one where it cannot be
  // split.
  bool split(const NodePtr& node, std::vector<SumRange> ranges, Summand summand) {
    if (const auto* negate = std::get_if<NegateNode>(&node->value)) {
      summand.negative = !summand.negative;
      return split(negate->operand, ranges, summand);
    }
    if (const auto* binary = std::get_if<BinaryNode>(&node->value)) {
      const bool difference = binary->operation == BinaryOperator::subtract;
      if (difference || binary->operation == BinaryOperator::add) {
        Summand right = summand;
        if (difference) right.negative = !right.negative;
        return split(binary->left, ranges, summand) && split(binary->right, ranges, right);
      }
      if (contains_sum(node)) {
        const bool left_sum = contains_sum(binary->left);
        const bool right_sum = contains_sum(binary->right);
        const bool divides = binary->operation == BinaryOperator::divide;
        const bool has_factor =
            divides ? !right_sum : binary->operation == BinaryOperator::multiply;
        if (!has_factor || (left_sum && right_sum)) return is_function(node, ranges, summand);
        return split_factor(*binary, left_sum, ranges, summand);
      }
      // (T + V)*c is T*c + V*c: what is separable becomes separate loops.
      const bool left_varies = touch(binary->left) != Touch{};
      if (touch(node).both() && !(left_varies && touch(binary->right) != Touch{}) &&
          (binary->operation == BinaryOperator::multiply ||
           (binary->operation == BinaryOperator::divide && left_varies))) {
        return split_factor(*binary, left_varies, ranges, summand);
      }
    }
    if (const auto* name = std::get_if<NameNode>(&node->value); name && !name->subscript) {
      if (const Definition* definition = find_definition(model_, name->name)) {
        return split(definition->value, ranges, summand);
      }
    }
    if (const auto* sum = std::get_if<SumNode>(&node->value)) {
      for (const SumRange& range : sum->ranges) {
        // A definition may use an index of the sum that it is named in.
        if (std::ranges::find(ranges, range.index, &SumRange::index) != ranges.end()) return false;
      }
      ranges.insert(ranges.end(), sum->ranges.begin(), sum->ranges.end());
      return split(sum->body, ranges, summand);
    }
    if (contains_sum(node)) return is_function(node, ranges, summand);
    summand.body = node;
    return place(ranges, summand);
  }

  bool is_function(const NodePtr& node, const std::vector<SumRange>& ranges, Summand summand) {
    if (!ranges.empty()) return false;
    summand.body = node;
    functions_.push_back(std::move(summand));
    return true;
  }

  // A product or quotient, of which one side is split and the other a factor.
  bool split_factor(const BinaryNode& binary, bool left, const std::vector<SumRange>& ranges,
                    Summand summand) {
    const bool divides = binary.operation == BinaryOperator::divide;
    if (!divides && binary.operation != BinaryOperator::multiply) return false;
    if (divides && !left) return false;
    summand.factors.emplace_back(left ? binary.right : binary.left, divides);
    return split(left ? binary.left : binary.right, ranges, summand);
  }

  // Puts the summand to those with the same ranges and variables.
  bool place(const std::vector<SumRange>& sum_ranges, const Summand& summand) {
    std::vector<KernelRange> ranges;
    std::vector<std::string> indices;
    for (const SumRange& range : sum_ranges) {
      const auto lower = affine(model_, range.lower, indices);
      const auto upper = affine(model_, range.upper, indices);
      if (!lower || !upper) return false;
      ranges.push_back({range.index, *lower, *upper});
      indices.push_back(range.index);
    }
    Touch mentioned = touch(summand.body);
    for (const auto& [factor, divides] : summand.factors) {
      const Touch more = touch(factor);
      mentioned = {mentioned.coordinates || more.coordinates, mentioned.momenta || more.momenta};
    }
    Distances distances;
    collect(summand.body, indices, distances);
    for (const auto& [factor, divides] : summand.factors) collect(factor, indices, distances);
    std::erase_if(distances, [](const auto& entry) { return entry.second.size() < 2; });
    const auto same = std::ranges::find_if(terms_, [&](const SumTerm& term) {
      return term.ranges == ranges && term.touch == mentioned && fit(term.distances, distances);
    });
    if (same != terms_.end()) {
      same->summands.push_back(summand);
      same->distances.merge(distances);
    } else {
      terms_.push_back({ranges, mentioned, {summand}, distances});
    }
    return true;
  }
  // Has none of the variables others in one than in the other?
  static bool fit(const Distances& a, const Distances& b) {
    return std::ranges::all_of(a, [&](const auto& entry) {
      const auto other = b.find(entry.first);
      return other == b.end() || other->second == entry.second;
    });
  }
  void collect(const NodePtr& node, const std::vector<std::string>& indices,
               Distances& found) const {
    if (const auto* name = std::get_if<NameNode>(&node->value)) {
      if (const Definition* definition = find_definition(model_, name->name))
        return collect(definition->value, indices, found);
      const auto subscript = name->subscript && touch(node) != Touch{}
                                 ? affine(model_, name->subscript, indices)
                                 : std::nullopt;
      if (subscript) found[name->name].insert(subscript_text(*subscript));
      return;
    }
    for_children(node, [&](const NodePtr& child) { collect(child, indices, found); });
  }

  [[nodiscard]] Touch touch(const NodePtr& node) const {
    Touch result;
    auto also = [&](const Touch& more) {
      result = {result.coordinates || more.coordinates, result.momenta || more.momenta};
    };
    if (const auto* name = std::get_if<NameNode>(&node->value)) {
      const auto is_named = [&](const Variable& variable) { return variable.name == name->name; };
      const bool coordinate = std::ranges::any_of(model_.coordinates, is_named);
      if (coordinate || std::ranges::any_of(model_.momenta, is_named)) {
        also({coordinate, !coordinate});
      } else if (const Definition* definition = find_definition(model_, name->name)) {
        also(touch(definition->value));
      }
      return result;
    }
    for_children(node, [&](const NodePtr& child) { also(touch(child)); });
    return result;
  }

  const Model& model_;
  std::vector<SumTerm> terms_;
  std::vector<Summand> functions_;
  mutable std::map<std::string, bool> has_sum_;  // of definitions
};

}  // namespace

std::optional<AffineIndex> affine(const Model& model, const NodePtr& node,
                                  const std::vector<std::string>& indices) {
  Indices at;
  for (const std::string& index : indices) at[index] = 0;
  AffineIndex result{.constant = integer(model, node, at)};
  long check = result.constant;
  for (const std::string& index : indices) {
    at[index] = 1;
    const long factor = integer(model, node, at) - result.constant;
    at[index] = 0;
    if (factor != 0) result.factors[index] = factor;
    check += 7 * factor;
  }
  for (const std::string& index : indices) at[index] = 7;
  if (integer(model, node, at) != check) return std::nullopt;
  return result;
}

std::optional<SplitSums> split_into_sums(const Model& model, const NodePtr& formula) {
  return SumSplitter(model).run(formula);
}

bool contains_sum(const Model& model, const NodePtr& node) {
  return SumSplitter(model).contains_sum(node);
}

const Definition* find_definition(const Model& model, const std::string& name) {
  const auto it = std::ranges::find(model.definitions, name, &Definition::name);
  return it == model.definitions.end() ? nullptr : &*it;
}

}  // namespace hamgen
