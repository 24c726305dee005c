// Degrees of freedom that rest: Note [the restricted step] in specialisation.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "generator/algebra/from_ginac.hpp"
#include "generator/algebra/functions.hpp"
#include "generator/specialise/specialisation.hpp"

namespace hamgen {

namespace {

using Pairs = std::set<int>;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool is_natural(const Expression& exponent) {
  return exponent.is_number() && exponent.number() > 0 && exponent.number().get_den() == 1;
}

bool is_analytic_at_zero(const std::string& function) {
  const Function* row = find_function(function);
  return row != nullptr && row->analytic_at_zero;
}

// The expression where variables are zero; empty if a corner or a pole is there.
std::optional<Expression> where_zero(const Expression& e, const Substitution& zeros) {
  if (e.is_number()) return e;
  if (e.kind() == Kind::symbol) return substitute(e, zeros);
  std::vector<Expression> operands;
  for (const Expression& operand : e.operands()) {
    std::optional<Expression> value = where_zero(operand, zeros);
    if (!value) return std::nullopt;
    operands.push_back(std::move(*value));
  }
  const bool has_pole =
      e.kind() == Kind::power && !is_natural(operands[1]) && vanishes(operands[0]);
  const bool has_corner = e.kind() == Kind::function && !is_analytic_at_zero(e.name()) &&
                          std::ranges::any_of(operands, vanishes);
  if (has_pole || has_corner) return std::nullopt;
  return with_operands(e, std::move(operands));
}

bool vanishes_where_zero(const Expression& e, const Substitution& zeros) {
  const std::optional<Expression> value = where_zero(e, zeros);
  return value && vanishes(*value);
}

const Member* member_of(const Scheme& scheme) {
  return scheme.has_member() ? &scheme.member() : nullptr;
}

// Variables and their momenta that a scene begins with at zero and nobody keeps.
Pairs starting_at_zero(const Mechanics& mechanics, const SceneFacts& scene) {
  const int n = mechanics.degrees_of_freedom;
  const auto is_kept = [&scene](const std::string& name) {
    return scene.kept.contains(name) || scene.kept.contains(name.substr(0, name.find('[')));
  };
  Pairs pairs;
  for (int i = 0; i < n; ++i) {
    if (mechanics.has_time && i == n - 1) continue;
    if (scene.values.q[at(i)] != 0 || scene.values.p[at(i)] != 0) continue;
    if (is_kept(mechanics.variables.name(at(i))) || is_kept(mechanics.variables.name(at(n + i))))
      continue;
    pairs.insert(i);
  }
  return pairs;
}

// Array and first position of a variable: "q" of "q[3]".
std::string base_of(const std::string& name) { return name.substr(0, name.find('[')); }

// Only arrays that are in the set as a whole: loops run over whole ones.
void keep_whole_arrays(const Mechanics& mechanics, Pairs& pairs) {
  const int n = mechanics.degrees_of_freedom;
  std::set<std::string> broken;
  for (int i = 0; i < n; ++i) {
    if (!pairs.contains(i)) {
      broken.insert(base_of(mechanics.variables.name(at(i))));
      broken.insert(base_of(mechanics.variables.name(at(n + i))));
    }
  }
  std::erase_if(pairs, [&](int i) {
    return broken.contains(base_of(mechanics.variables.name(at(i)))) ||
           broken.contains(base_of(mechanics.variables.name(at(n + i))));
  });
}

// The pair of the element that a slot is at its first instance.
int pair_of(const Slot& slot, const Kernel& kernel, int n) {
  std::vector<long> first;
  for (const KernelRange& range : kernel.ranges)
    first.push_back(value_at(range.lower, kernel.ranges, first));
  return static_cast<int>(value_at(slot.position, kernel.ranges, first)) % n;
}

Substitution zeros_of(const Kernel& kernel, const Pairs& pairs, int n) {
  Substitution zeros;
  for (const Slot& slot : kernel.slots) {
    if (pairs.contains(pair_of(slot, kernel, n))) zeros.emplace(slot.symbol, Expression(0));
  }
  return zeros;
}

Substitution zeros_of(const Mechanics& mechanics, const Pairs& pairs) {
  const int n = mechanics.degrees_of_freedom;
  Substitution zeros;
  for (const int i : pairs) {
    zeros.emplace(mechanics.variables.name(at(i)), Expression(0));
    zeros.emplace(mechanics.variables.name(at(n + i)), Expression(0));
  }
  return zeros;
}

// Members that H moves where all of them are zero.
Pairs driven(const Mechanics& mechanics, const Pairs& pairs) {
  const int n = mechanics.degrees_of_freedom;
  Pairs result;
  const Substitution zeros = zeros_of(mechanics, pairs);
  if (!mechanics.keeps_sums()) {
    for (const int i : pairs) {
      if (!vanishes_where_zero(mechanics.gradient[at(i)], zeros) ||
          !vanishes_where_zero(mechanics.gradient[at(n + i)], zeros))
        result.insert(i);
    }
    return result;
  }
  for (const Kernel& kernel : mechanics.kernels) {
    const Substitution of_slots = zeros_of(kernel, pairs, n);
    for (std::size_t s = 0; s < kernel.slots.size(); ++s) {
      const int i = pair_of(kernel.slots[s], kernel, n);
      if (pairs.contains(i) && !vanishes_where_zero(kernel.gradient[s], of_slots)) result.insert(i);
    }
  }
  return result;
}

// Members that a row of C moves.
Pairs driven(const Member& member, const Pairs& pairs, int n) {
  Pairs result;
  for (const auto& [place, entry] : of_all(member, n).c) {
    const int row = place.first % n;
    if (pairs.contains(row) && !pairs.contains(place.second % n) && !vanishes(entry))
      result.insert(row);
  }
  return result;
}

}  // namespace

std::vector<int> resting(const Mechanics& mechanics, const Scheme& scheme,
                         const SceneFacts& scene) {
  const Member* member = member_of(scheme);
  if (member != nullptr && !gauge_defect(*member).empty()) return {};
  if (!mechanics.sums.empty()) return {};  // to which also what rests adds
  Pairs pairs = starting_at_zero(mechanics, scene);
  while (!pairs.empty()) {
    if (mechanics.keeps_sums()) keep_whole_arrays(mechanics, pairs);
    Pairs moved = driven(mechanics, pairs);
    if (member != nullptr) moved.merge(driven(*member, pairs, mechanics.degrees_of_freedom));
    if (moved.empty()) break;
    for (const int i : moved) pairs.erase(i);
  }
  // H itself has a value there, and no corner.
  const Substitution zeros = zeros_of(mechanics, pairs);
  if (!mechanics.keeps_sums() && !where_zero(mechanics.energy, zeros)) return {};
  if (static_cast<int>(pairs.size()) == mechanics.degrees_of_freedom) return {};
  return {pairs.begin(), pairs.end()};
}

std::string to_text(const std::vector<int>& resting, const Mechanics& mechanics) {
  const int n = mechanics.degrees_of_freedom;
  const Pairs pairs(resting.begin(), resting.end());
  std::vector<std::string> names;
  for (const bool momenta : {false, true}) {
    std::map<std::string, std::pair<int, int>> arrays;  // elements that rest, all elements
    for (int i = 0; i < n; ++i) {
      auto& [rest, all] = arrays[base_of(mechanics.variables.name(at(momenta ? n + i : i)))];
      rest += pairs.contains(i) ? 1 : 0;
      ++all;
    }
    std::set<std::string> said;
    for (const int i : resting) {
      const std::string& name = mechanics.variables.name(at(momenta ? n + i : i));
      const auto& [rest, all] = arrays[base_of(name)];
      const std::string text = rest == all && all > 1 ? base_of(name) : name;
      if (said.insert(text).second) names.push_back(text);
    }
  }
  return fmt::format("{}: they start at 0, and nothing moves them", fmt::join(names, ", "));
}

}  // namespace hamgen
