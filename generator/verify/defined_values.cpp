#include "generator/verify/defined_values.hpp"

#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

namespace {

std::optional<std::size_t> last(const ExpressionMap<std::set<std::size_t>>& places,
                                const Expression& value) {
  const auto it = places.find(value);
  if (it == places.end() || it->second.empty()) return {};
  return *it->second.rbegin();
}

}  // namespace

void DefinedValues::add(const std::string& name, const Expression& value) {
  places_[name] = all_.size();
  by_value_[value].insert(all_.size());
  all_.push_back({name, value});
}

std::optional<std::size_t> DefinedValues::place(const std::string& name) const {
  const auto it = places_.find(name);
  if (it == places_.end()) return {};
  return it->second;
}

void DefinedValues::change(std::size_t place, const Expression& value) {
  by_value_[all_[place].value].erase(place);
  by_value_[value].insert(place);
  all_[place].value = value;
  forget_from(place);
}

std::optional<std::size_t> DefinedValues::computed_as(const Expression& exact) {
  if (const auto place = last(by_value_, exact)) return place;
  compare();
  return last(by_compared_, substitute(exact, first_name_));
}

void DefinedValues::compare() {
  for (std::size_t i = compared_.size(); i < all_.size(); ++i) {
    const Expression value = substitute(all_[i].value, first_name_);
    const auto name_of = [&](std::size_t place) {
      return Expression::symbol(all_[place].name, kRankOfTemporary);
    };
    compared_.push_back(value);
    std::set<std::size_t>& equal = by_compared_[value];
    if (!equal.empty()) {
      first_name_.emplace(all_[i].name, name_of(*equal.begin()));
    } else if (const auto negated = by_compared_.find(-value);
               negated != by_compared_.end() && !negated->second.empty()) {
      first_name_.emplace(all_[i].name, -name_of(*negated->second.begin()));
    }
    by_compared_[value].insert(i);
  }
}

void DefinedValues::forget_from(std::size_t place) {
  while (compared_.size() > place) {
    const std::size_t i = compared_.size() - 1;
    by_compared_[compared_.back()].erase(i);
    first_name_.erase(all_[i].name);
    compared_.pop_back();
  }
}

}  // namespace hamgen
