// A system and its scheme without some degrees of freedom, whose variables are zero.
#include <algorithm>

#include "generator/algebra/from_ginac.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/specialise/specialisation.hpp"

namespace hamgen {

namespace {

std::size_t place_at(int i) { return static_cast<std::size_t>(i); }

// Where each variable of the whole system is in the restricted one; -1 if nowhere.
std::vector<int> new_places(int n, const std::vector<int>& kept) {
  std::vector<int> places(place_at(2 * n), -1);
  const int m = static_cast<int>(kept.size());
  for (int i = 0; i < m; ++i) {
    places[place_at(kept[place_at(i)])] = i;
    places[place_at(n + kept[place_at(i)])] = m + i;
  }
  return places;
}

// A momentum that has become a parameter.
Expression constant_momentum(const Mechanics& whole, int i) {
  const auto place = place_at(whole.degrees_of_freedom + i);
  return Expression::symbol(whole.variables.name(place), kRankOfParameter + 50'000 + i);
}

// H without the terms of variables nobody looks at, which stand in no other term.
Expression without(const Expression& energy, const std::set<std::string>& names) {
  if (names.empty()) return energy;
  const auto mentions = [&names](const Expression& e) {
    const std::set<std::string> used = symbols(e);
    return std::ranges::any_of(used, [&](const auto& name) { return names.contains(name); });
  };
  const auto [factor, rest] = energy.split_coefficient();
  if (rest.kind() != Kind::sum) return mentions(energy) ? Expression(0) : energy;
  std::vector<Expression> terms;
  for (const Expression& term : rest.operands()) {
    if (!mentions(term)) terms.push_back(Expression(factor) * term);
  }
  return Expression::sum(std::move(terms));
}

Substitution renumbered(const Mechanics& whole, const std::vector<int>& places) {
  Substitution replacements;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string& name = whole.variables.name(i);
    replacements.emplace(name, places[i] < 0
                                   ? Expression(0)
                                   : Expression::symbol(name, kRankOfVariable + places[i]));
  }
  return replacements;
}

// The kernel without the slots of what is zero, and without terms of what nobody looks at.  Arrays
// stay or go as a whole, so that a position moves by the same number in all instances.
Kernel restricted(const Kernel& kernel, const std::vector<int>& places, const Mechanics& whole,
                  const std::set<std::string>& unknown) {
  Kernel result;
  result.ranges = kernel.ranges;
  result.parameters = kernel.parameters;
  result.terms = kernel.terms;
  std::vector<long> first;
  for (const KernelRange& range : kernel.ranges)
    first.push_back(value_at(range.lower, kernel.ranges, first));
  Substitution zeros;
  std::set<std::string> unknown_slots;
  std::vector<std::size_t> slots;
  for (std::size_t s = 0; s < kernel.slots.size(); ++s) {
    const long position = value_at(kernel.slots[s].position, kernel.ranges, first);
    const int place = places[static_cast<std::size_t>(position)];
    if (place < 0) {
      zeros.emplace(kernel.slots[s].symbol, Expression(0));
      if (unknown.contains(whole.variables.name(place_at(static_cast<int>(position)))))
        unknown_slots.insert(kernel.slots[s].symbol);
      continue;
    }
    slots.push_back(s);
    result.slots.push_back(kernel.slots[s]);
    result.slots.back().position.constant += place - position;
  }
  result.value = substitute(without(kernel.value, unknown_slots), zeros);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    result.gradient.push_back(substitute(kernel.gradient[slots[i]], zeros));
    for (std::size_t j = i; j < slots.size(); ++j) {
      const auto it = kernel.hessian.find({slots[i], slots[j]});
      if (it == kernel.hessian.end()) continue;
      const Expression entry = substitute(it->second, zeros);
      if (!vanishes(entry)) result.hessian.emplace(std::pair(i, j), entry);
    }
  }
  return result;
}

SparseMatrix restricted(const SparseMatrix& c, const std::vector<int>& places) {
  SparseMatrix result;
  for (const auto& [place, entry] : c) {
    const int row = places[place_at(place.first)];
    const int column = places[place_at(place.second)];
    if (row >= 0 && column >= 0) result.emplace(std::pair(row, column), entry);
  }
  return result;
}

void restrict_member(Member& member, const std::vector<int>& kept) {
  if (member.degrees_of_freedom <= static_cast<int>(kept.size())) return;
  member.c = restricted(member.c, new_places(member.degrees_of_freedom, kept));
  member.degrees_of_freedom = static_cast<int>(kept.size());
}

}  // namespace

Expression restrict_to(const Expression& e, const Mechanics& whole, const std::vector<int>& kept,
                       const Unobserved& left) {
  std::set<std::string> unknown;
  for (const int i : left.dropped) {
    unknown.insert(whole.variables.name(place_at(i)));
    unknown.insert(whole.variables.name(place_at(whole.degrees_of_freedom + i)));
  }
  return substitute(without(e, unknown),
                    renumbered(whole, new_places(whole.degrees_of_freedom, kept)));
}

Mechanics restrict_to(const Mechanics& mechanics, const std::vector<int>& kept,
                      const Unobserved& left) {
  const int n = mechanics.degrees_of_freedom;
  if (static_cast<int>(kept.size()) == n) return mechanics;
  const std::vector<int> places = new_places(n, kept);
  Substitution replacements = renumbered(mechanics, places);
  for (const int i : left.cyclic)
    replacements.insert_or_assign(mechanics.variables.name(place_at(n + i)),
                                  constant_momentum(mechanics, i));
  std::set<std::string> unknown;
  for (const int i : left.dropped) {
    unknown.insert(mechanics.variables.name(place_at(i)));
    unknown.insert(mechanics.variables.name(place_at(n + i)));
  }
  const auto here = [&replacements](const Expression& e) { return substitute(e, replacements); };
  Mechanics result = mechanics;
  result.degrees_of_freedom = static_cast<int>(kept.size());
  result.variables.clear();
  result.gradient.clear();
  result.hessian.clear();
  result.kernels.clear();
  for (int i = 0; i < 2 * n; ++i) {
    if (places[place_at(i)] < 0) continue;
    result.variables.push_back(mechanics.variables[place_at(i)]);
    if (!mechanics.keeps_sums()) {
      const Expression slope = here(mechanics.gradient[place_at(i)]);
      result.gradient.push_back(vanishes(slope) ? Expression(0) : slope);
    }
  }
  result.energy = here(without(mechanics.energy, unknown));
  for (const int i : left.cyclic) {
    result.parameters.push_back(mechanics.variables[place_at(n + i)]);
    if (result.parameters.back().comment.empty())
      result.parameters.back().comment = "constant: its coordinate is cyclic";
  }
  for (const auto& [place, value] : mechanics.hessian) {
    const int row = places[place_at(place.first)];
    const int column = places[place_at(place.second)];
    if (row < 0 || column < 0) continue;
    const Expression entry = here(value);
    if (!vanishes(entry)) result.hessian.emplace(std::pair(row, column), entry);
  }
  for (const Kernel& kernel : mechanics.kernels) {
    Kernel rest = restricted(kernel, places, mechanics, unknown);
    if (!rest.slots.empty()) result.kernels.push_back(std::move(rest));
  }
  for (NamedExpression& invariant : result.invariants) invariant.value = here(invariant.value);
  return result;
}

Scheme restrict_to(const Scheme& scheme, const std::vector<int>& kept) {
  Scheme result = scheme;
  if (auto* member = std::get_if<Member>(&result.method)) {
    restrict_member(*member, kept);
  } else if (auto* composition = std::get_if<Composition>(&result.method)) {
    restrict_member(composition->base, kept);
  }
  return result;
}

}  // namespace hamgen
