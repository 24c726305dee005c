#include "generator/verify/growing_events.hpp"

#include <utility>

namespace hamgen {

namespace {

bool is_same(const CodeEvent& a, const CodeEvent& b) {
  return a.kind == b.kind && a.text == b.text && a.names == b.names && a.lanes == b.lanes &&
         a.numbers.size() == b.numbers.size();
}

}  // namespace

std::vector<GrowingEvent> affine_events(const std::array<SizedOutline, 3>& sizes) {
  const auto& [a, b, c] = sizes;
  if (a.events.size() != b.events.size() || a.events.size() != c.events.size())
    throw NotLonger{"its routines have other instructions"};
  std::vector<GrowingEvent> merged;
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    const CodeEvent& event = a.events[i];
    if (!is_same(event, b.events[i]) || !is_same(event, c.events[i]))
      throw NotLonger{"its routines have other instructions"};
    GrowingEvent growing{event, {}};
    for (std::size_t j = 0; j < event.numbers.size(); ++j) {
      const long first = event.numbers[j];
      const long slope = (b.events[i].numbers[j] - first) / (b.size - a.size);
      const AffineNumber number{first - slope * a.size, slope};
      const auto at = [&](long size) { return number.near + slope * size; };
      if (b.events[i].numbers[j] != at(b.size) || c.events[i].numbers[j] != at(c.size))
        throw NotLonger{"its places are not affine in the size"};
      growing.numbers.push_back(number);
    }
    merged.push_back(std::move(growing));
  }
  return merged;
}

}  // namespace hamgen
