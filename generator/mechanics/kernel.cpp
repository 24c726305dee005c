#include "generator/mechanics/kernel.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hamgen {

bool uses_coordinates(const Kernel& kernel) {
  return std::ranges::any_of(kernel.slots, [](const Slot& s) { return !s.is_momentum; });
}

bool uses_momenta(const Kernel& kernel) {
  return std::ranges::any_of(kernel.slots, &Slot::is_momentum);
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

long value_at(const AffineIndex& index, const std::vector<KernelRange>& ranges,
              const std::vector<long>& indices) {
  long value = index.constant;
  for (std::size_t k = 0; k < indices.size() && !index.factors.empty(); ++k) {
    const auto it = index.factors.find(ranges[k].index);
    if (it != index.factors.end()) value += it->second * indices[k];
  }
  return value;
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
