#include "generator/mechanics/quantity_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace hamgen {

namespace {

// "q[12]" becomes "q" at 12.
bool take_index(std::string& name, long& index) {
  const std::size_t bracket = name.find('[');
  if (bracket == std::string::npos || name.back() != ']') return false;
  const char* end = name.data() + name.size() - 1;
  const auto [stopped, error] = std::from_chars(name.data() + bracket + 1, end, index);
  if (error != std::errc() || stopped != end) return false;
  name.resize(bracket);
  return true;
}

}  // namespace

void QuantityList::append(Quantity array, long first, long count) {
  if (count <= 0) return;
  runs_.push_back({.of = std::move(array),
                   .indexed = true,
                   .first = first,
                   .begin = size(),
                   .count = static_cast<std::size_t>(count)});
}

void QuantityList::push_back(Quantity quantity) {
  long index = 0;
  const bool indexed = take_index(quantity.name, index);
  if (indexed && !runs_.empty()) {
    Run& last = runs_.back();
    const bool follows = last.indexed && last.of.name == quantity.name &&
                         last.first + static_cast<long>(last.count) == index &&
                         last.of.unit == quantity.unit && last.of.comment == quantity.comment &&
                         last.of.value == quantity.value;
    if (follows) {
      ++last.count;
      return;
    }
  }
  const std::size_t begin = size();
  runs_.push_back(
      {.of = std::move(quantity), .indexed = indexed, .first = index, .begin = begin, .count = 1});
}

const QuantityList::Run& QuantityList::run_of(std::size_t i) const {
  return *std::prev(std::ranges::upper_bound(runs_, i, {}, &Run::begin));
}

std::string QuantityList::name(std::size_t i) const {
  const Run& run = run_of(i);
  return run.indexed
             ? fmt::format("{}[{}]", run.of.name, run.first + static_cast<long>(i - run.begin))
             : run.of.name;
}

long QuantityList::element(std::size_t i) const {
  const Run& run = run_of(i);
  return run.first + static_cast<long>(i - run.begin);
}

Quantity QuantityList::operator[](std::size_t i) const {
  const Run& run = run_of(i);
  return {name(i), run.of.unit, run.of.comment, run.of.value};
}

QuantityList names_of(const std::vector<Quantity>& quantities) {
  QuantityList list;
  for (Quantity each : quantities) {
    each.value = 0;
    list.push_back(std::move(each));
  }
  return list;
}

}  // namespace hamgen
