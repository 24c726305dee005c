#include "generator/program/first_loop.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <utility>

namespace hamgen {

namespace {

// Where the elements stand that the instance 0 of a loop would meet; none if they do not move with
// the loop, one by one.
std::optional<std::set<long>> places_of(const Kernel& kernel, bool momenta, long first) {
  std::set<long> places;
  for (std::size_t s = 0; s < kernel.slots.size(); ++s) {
    const Slot& slot = kernel.slots[s];
    if (kernel.ranges.size() == 1 && is_fixed(kernel, slot)) continue;  // a sum besides
    if (slot.is_momentum != momenta || kernel.gradient[s].is_zero()) continue;
    const std::map<std::string, long> one_by_one = {{kernel.ranges.front().index, 1}};
    if (kernel.ranges.size() != 1 || slot.position.factors != one_by_one) return {};
    places.insert(slot.position.constant - first);
  }
  return places;
}

}  // namespace

std::optional<FirstLoop> first_loop(const std::vector<Kernel>& kernels, bool momenta,
                                    int degrees_of_freedom) {
  for (const Kernel& kernel : kernels) {
    if (kernel.ranges.empty()) continue;
    const std::optional<std::set<long>> places =
        places_of(kernel, momenta, momenta ? degrees_of_freedom : 0);
    if (!places) return {};
    if (places->empty()) continue;
    const KernelRange& range = kernel.ranges.front();
    FirstLoop loop{&kernel, {}};
    for (const long place : *places) {
      const long first = range.lower.constant + place;
      if (!loop.covered.empty() && first <= loop.covered.back().second) return {};
      loop.covered.emplace_back(first, range.upper.constant + place);
    }
    return loop;
  }
  return {};
}

namespace {

void add_zeros_between(Routine& routine, const std::string& array, long first, long last) {
  const auto bind = [&](const std::string& symbol, Place place) {
    routine.places.insert_or_assign(symbol, std::move(place));
    return symbol;
  };
  for (long i = first; last - first < 2 && i <= last; ++i) {
    const AffineIndex at{i, {}};
    const std::string element =
        bind(fmt::format("{}({})", array, i), {.object = array, .indices = {at}});
    routine.body.push_back({Assign{element, Expression(0)}});
  }
  if (last - first < 2) return;
  const std::string element = bind(array + "(i)", {.object = array, .indices = {{0, {{"i", 1}}}}});
  Body zero{{Assign{element, Expression(0)}}};
  routine.body.push_back({For{{"i", {first, {}}, {last, {}}}, std::move(zero)}});
}

}  // namespace

void add_zeros(Routine& routine, const std::string& array, const Elements& covered, int n) {
  long next = 0;
  for (const auto& [first, last] : covered) {
    add_zeros_between(routine, array, next, first - 1);
    next = last + 1;
  }
  add_zeros_between(routine, array, next, n - 1);
}

}  // namespace hamgen
