#include "generator/mechanics/kernel.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hamgen {

bool uses_coordinates(const Kernel& kernel) {
  return std::ranges::any_of(kernel.slots, [](const Slot& s) { return !s.is_momentum; });
}

bool is_fixed(const Kernel& kernel, const Slot& slot) {
  return !kernel.ranges.empty() && slot.position.factors.empty();
}

std::set<std::string> varying_symbols(const Kernel& kernel) {
  std::set<std::string> symbols;
  for (const Slot& slot : kernel.slots) {
    if (!is_fixed(kernel, slot)) symbols.insert(slot.symbol);
  }
  return symbols;
}

bool uses_momenta(const Kernel& kernel) {
  return std::ranges::any_of(kernel.slots, &Slot::is_momentum);
}

bool is_polynomial(const Kernel& kernel) {
  const std::set<std::string> beyond = non_polynomial_symbols(kernel.value);
  return std::ranges::none_of(kernel.slots,
                              [&](const Slot& slot) { return beyond.contains(slot.symbol); });
}

std::string to_text(const AffineIndex& index) {
  std::string text;
  for (const auto& [name, factor] : index.factors) {
    const long size = std::abs(factor);
    text += text.empty() ? (factor < 0 ? "-" : "") : (factor < 0 ? " - " : " + ");
    text += size == 1 ? name : fmt::format("{}*{}", size, name);
  }
  if (text.empty()) return std::to_string(index.constant);
  if (index.constant == 0) return text;
  return text + fmt::format(" {} {}", index.constant < 0 ? '-' : '+', std::abs(index.constant));
}

std::string subscript_text(const AffineIndex& index) {
  std::string text;
  for (const auto& [name, factor] : index.factors) {
    if (factor == 1) {
      text += (text.empty() ? "" : "+") + name;
    } else {
      text += fmt::format("{}{}*{}", text.empty() || factor < 0 ? "" : "+", factor, name);
    }
  }
  if (index.constant != 0 || text.empty()) {
    text += fmt::format("{}{}", text.empty() || index.constant < 0 ? "" : "+", index.constant);
  }
  return text;
}

long value_at(const AffineIndex& index, const std::vector<KernelRange>& ranges,
              const std::vector<long>& indices) {
  long value = index.constant;
  for (std::size_t k = 0; k < indices.size() && !index.factors.empty(); ++k) {
    const auto it = index.factors.find(ranges[k].index);
    if (it != index.factors.end()) value += it->second * indices[k];
  }
  return value;
}

namespace {

long extreme(AffineIndex a, const std::vector<KernelRange>& ranges, bool largest) {
  for (auto range = ranges.rbegin(); range != ranges.rend(); ++range) {
    const auto found = a.factors.find(range->index);
    if (found == a.factors.end()) continue;
    const long factor = found->second;
    a.factors.erase(found);
    const AffineIndex& end = (factor > 0) == largest ? range->upper : range->lower;
    a.constant += factor * end.constant;
    for (const auto& [index, of_end] : end.factors) a.factors[index] += factor * of_end;
  }
  return a.constant;
}

long rounded_up(long a, long positive) { return a / positive + (a % positive > 0 ? 1 : 0); }
long rounded_down(long a, long positive) { return -rounded_up(-a, positive); }

}  // namespace

long least_value(const AffineIndex& index, const std::vector<KernelRange>& ranges) {
  return extreme(index, ranges, false);
}

long largest_value(const AffineIndex& index, const std::vector<KernelRange>& ranges) {
  return extreme(index, ranges, true);
}

IndexInterval indices_between(const AffineIndex& place, const std::string& index, long least,
                              long most) {
  const auto found = place.factors.find(index);
  const long factor = found == place.factors.end() ? 0 : found->second;
  const long below = least - place.constant;
  const long above = most - place.constant;
  if (factor == 0)
    return below <= 0 && above >= 0 ? IndexInterval{} : IndexInterval{.first = 1, .last = 0};
  if (factor > 0) return {rounded_up(below, factor), rounded_down(above, factor)};
  return {rounded_up(-above, -factor), rounded_down(-below, -factor)};
}

void for_each_instance(const std::vector<KernelRange>& ranges,
                       const std::function<void(const std::vector<long>&)>& use) {
  std::vector<long> indices;
  const std::function<void()> descend = [&] {
    if (indices.size() == ranges.size()) {
      use(indices);
      return;
    }
    const KernelRange& range = ranges[indices.size()];
    const long last = value_at(range.upper, ranges, indices);
    for (long i = value_at(range.lower, ranges, indices); i <= last; ++i) {
      indices.push_back(i);
      descend();
      indices.pop_back();
    }
  };
  descend();
}

}  // namespace hamgen
