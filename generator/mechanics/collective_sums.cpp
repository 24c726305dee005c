#include "generator/mechanics/collective_sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "generator/mechanics/mechanics.hpp"
#include "generator/mechanics/to_ginac.hpp"

namespace hamgen {

namespace {

class SumCollector {
 public:
  explicit SumCollector(const Model& model) : model_(model) {}

  std::optional<CollectiveSums> run(const std::vector<Summand>& functions) {
    for (const Summand& function : functions) {
      touched_ = {};
      if (!find(function.body, "") || touched_.both()) return std::nullopt;
      for (const auto& [factor, divides] : function.factors) {
        if (!find(factor, "")) return std::nullopt;
      }
    }
    differentiate(functions);
    return std::move(result_);
  }

 private:
  // The sums that stand there; `name` is what their definition is called.
  bool find(const NodePtr& node, const std::string& name) {
    if (const auto* sum = std::get_if<SumNode>(&node->value)) return add(*sum, node, name);
    if (const auto* named = std::get_if<NameNode>(&node->value)) {
      const auto is_named = [&](const Variable& variable) { return variable.name == named->name; };
      if (std::ranges::any_of(model_.coordinates, is_named) ||
          std::ranges::any_of(model_.momenta, is_named))
        return false;
      const Definition* definition = find_definition(model_, named->name);
      return definition == nullptr || find(definition->value, definition->name);
    }
    bool good = true;
    for_children(node, [&](const NodePtr& child) { good = good && find(child, ""); });
    return good;
  }

  bool add(const SumNode& sum, const NodePtr& node, const std::string& name) {
    const auto known = std::ranges::find(nodes_, &sum);
    const auto place = static_cast<std::size_t>(known - nodes_.begin());
    if (known == nodes_.end()) {
      std::optional<SplitSums> split = split_into_sums(model_, node);
      if (!split || !split->functions.empty()) return false;
      nodes_.push_back(&sum);
      const std::string symbol = name.empty() ? fmt::format("sum({})", nodes_.size()) : name;
      result_.sums.push_back({symbol, "H(" + symbol + ")", {}});
      result_.terms.push_back(std::move(split->terms));
    }
    for (const SumTerm& term : result_.terms[place]) {
      touched_ = {touched_.coordinates || term.touch.coordinates,
                  touched_.momenta || term.touch.momenta};
    }
    return true;
  }

  void differentiate(const std::vector<Summand>& functions) {
    SymbolTable table;
    TreeConverter converter(model_, table);
    std::vector<GiNaC::ex> symbols;
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      symbols.push_back(table.symbol(result_.sums[k].name, kRankOfTemporary + static_cast<int>(k)));
    converter.set_sum([&](const SumNode& sum) -> std::optional<GiNaC::ex> {
      const auto known = std::ranges::find(nodes_, &sum);
      if (known == nodes_.end()) return std::nullopt;
      return symbols[static_cast<std::size_t>(known - nodes_.begin())];
    });
    GiNaC::ex value = 0;
    for (const Summand& function : functions) {
      GiNaC::ex term = converter.convert(function.body);
      for (const auto& [factor, divides] : function.factors) {
        const GiNaC::ex by = converter.convert(factor);
        term = divides ? term / by : term * by;
      }
      value += function.negative ? GiNaC::ex(-term) : term;
    }
    result_.value = from_ginac(value, table);
    for (CollectiveSum& sum : result_.sums)
      sum.slope_value = from_ginac(value.diff(table.find(sum.name)), table);
  }

  const Model& model_;
  std::vector<const SumNode*> nodes_;
  Touch touched_;  // by the sums of one function
  CollectiveSums result_;
};

}  // namespace

std::optional<CollectiveSums> collective_sums(const Model& model,
                                              const std::vector<Summand>& functions) {
  return SumCollector(model).run(functions);
}

}  // namespace hamgen
