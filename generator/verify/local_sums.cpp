#include "generator/verify/local_sums.hpp"

#include "generator/verify/growing_events.hpp"

namespace hamgen {

void LocalSums::begin_routine() {
  sums_.clear();
  declared_in_.clear();
}

void LocalSums::begin_nest() {
  read_here_.clear();
  for (auto& each : sums_) each.second.grows = false;
}

void LocalSums::declare(const std::string& name, long loops) { declared_in_[name] = loops; }

void LocalSums::add(const std::string& name, bool in_pairs, long inside) {
  Sum& sum = sums_[name];
  if (sum.is_read || read_here_.contains(name))
    throw NotLonger{"a sum over all elements grows after it was read"};
  sum.grows = true;
  sum.of_pairs = sum.of_pairs || in_pairs;
  // In a loop that does not grow it would go on with what is there of the time before.
  sum.goes_on = sum.goes_on || !declared_in_.contains(name) || declared_in_[name] != inside;
}

bool LocalSums::read(const std::string& name, bool in_growing) {
  if (in_growing) read_here_.insert(name);
  const auto found = sums_.find(name);
  if (found == sums_.end()) return false;
  Sum& sum = found->second;
  if (sum.grows) throw NotLonger{"an instance of a loop reads what another one writes"};
  if (sum.of_pairs) throw NotLonger{"a sum over pairs is looked into"};
  if (sum.goes_on) throw NotLonger{"a sum over all elements goes on from loop to loop"};
  sum.is_read = true;
  return true;
}

}  // namespace hamgen
