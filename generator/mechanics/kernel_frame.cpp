#include "generator/mechanics/kernel_frame.hpp"

#include <algorithm>

#include "generator/algebra/derivative.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

// The elements of an array that the place is one of.
const QuantityList::Run& run_around(const QuantityList& list, long place) {
  const auto is_in = [place](const QuantityList::Run& run) {
    return place < static_cast<long>(run.begin + run.count);
  };
  const auto found = std::ranges::find_if(list.runs(), is_in);
  if (found == list.runs().end()) internal_error("a slot that is no element of the state");
  return *found;
}

// By place, whatever the length of the system.
int rank_of(const AffineIndex& position, const std::vector<KernelRange>& ranges) {
  return kRankOfVariable + static_cast<int>(least_value(position, ranges));
}

}  // namespace

AffineIndex composed(const AffineIndex& index, const std::string& name, const AffineIndex& value) {
  const auto found = index.factors.find(name);
  if (found == index.factors.end()) return index;
  AffineIndex result = index;
  result.factors.erase(name);
  result.constant += found->second * value.constant;
  for (const auto& [other, factor] : value.factors) {
    long& sum = result.factors[other];
    sum += found->second * factor;
    if (sum == 0) result.factors.erase(other);
  }
  return result;
}

KernelFrame::KernelFrame(const Mechanics& mechanics, std::optional<KernelRange> range)
    : mechanics_(&mechanics) {
  if (range) kernel_.ranges.push_back(std::move(*range));
}

Expression KernelFrame::element(const AffineIndex& position) {
  const long first = least_value(position, kernel_.ranges);
  const int rank = rank_of(position, kernel_.ranges);
  const auto known = std::ranges::find(kernel_.slots, position, &Slot::position);
  if (known != kernel_.slots.end()) return Expression::symbol(known->symbol, rank);
  std::string symbol = mechanics_->variables.name(static_cast<std::size_t>(first));
  if (!position.factors.empty()) {
    const QuantityList::Run& run = run_around(mechanics_->variables, first);
    AffineIndex subscript = position;
    subscript.constant += run.first - static_cast<long>(run.begin);
    symbol = run.of.name + "[" + subscript_text(subscript) + "]";
  }
  kernel_.slots.push_back({symbol, position, first >= mechanics_->degrees_of_freedom});
  return Expression::symbol(symbol, rank);
}

Expression KernelFrame::parameter(const ParameterSlot& slot, const AffineIndex& position) {
  const std::string array = slot.parameter + "[";
  const auto first = std::ranges::find_if(
      mechanics_->parameters, [&](const Quantity& each) { return each.name.starts_with(array); });
  if (first == mechanics_->parameters.end()) internal_error("no array " + slot.parameter);
  AffineIndex subscript = position;
  subscript.constant += std::stol(first->name.substr(array.size()));
  const std::string symbol = array + subscript_text(subscript) + "]";
  const bool known = std::ranges::find(kernel_.parameters, symbol, &ParameterSlot::symbol) !=
                     kernel_.parameters.end();
  if (!known) kernel_.parameters.push_back({symbol, slot.parameter, position});
  const bool single = position.factors.empty();
  const auto rank = (first - mechanics_->parameters.begin()) + (single ? position.constant : 0);
  return Expression::symbol(symbol, kRankOfParameter + (single ? static_cast<int>(rank) : 0));
}

Expression KernelFrame::seen(const Kernel& kernel, const AffineIndex& at, const Expression& e) {
  const std::string index = kernel.ranges.empty() ? "" : kernel.ranges.front().index;
  Substitution names;
  for (const Slot& slot : kernel.slots) {
    if (depends_on(e, slot.symbol))
      names.emplace(slot.symbol, element(composed(slot.position, index, at)));
  }
  for (const ParameterSlot& slot : kernel.parameters) {
    if (depends_on(e, slot.symbol))
      names.emplace(slot.symbol, parameter(slot, composed(slot.position, index, at)));
  }
  if (!index.empty()) {
    Expression value(at.constant);
    for (const auto& [name, factor] : at.factors)
      value += Expression(factor) * Expression::symbol(name, kRankOfParameter);
    names.emplace(index, value);
  }
  return substitute(e, names);
}

std::optional<AffineIndex> KernelFrame::place(const std::string& symbol) const {
  const auto found = std::ranges::find(kernel_.slots, symbol, &Slot::symbol);
  return found == kernel_.slots.end() ? std::nullopt : std::optional(found->position);
}

namespace {

std::vector<Expression> symbols_of(const Kernel& kernel) {
  std::vector<Expression> result;
  for (const Slot& slot : kernel.slots)
    result.push_back(Expression::symbol(slot.symbol, rank_of(slot.position, kernel.ranges)));
  return result;
}

}  // namespace

Kernel KernelFrame::kernel(const Expression& value, std::set<int> terms) const {
  Kernel result{.ranges = kernel_.ranges,
                .slots = {},
                .parameters = {},
                .value = value,
                .gradient = {},
                .hessian = {},
                .terms = std::move(terms)};
  const std::set<std::string> used = symbols(value);
  const auto is_used = [&](const auto& slot) { return used.contains(slot.symbol); };
  std::ranges::copy_if(kernel_.slots, std::back_inserter(result.slots), is_used);
  std::ranges::copy_if(kernel_.parameters, std::back_inserter(result.parameters), is_used);
  std::ranges::sort(result.slots, {},
                    [&](const Slot& slot) { return rank_of(slot.position, result.ranges); });
  result.gradient = gradient(value, symbols_of(result));
  return result;
}

Kernel with_second_derivatives(Kernel kernel) {
  const std::vector<Expression> variables = symbols_of(kernel);
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const std::vector<Expression> row = gradient(kernel.gradient[i], variables);
    for (std::size_t j = i; j < variables.size(); ++j) {
      if (!row[j].is_zero()) kernel.hessian.emplace(std::pair(i, j), row[j]);
    }
  }
  return kernel;
}

}  // namespace hamgen
