// The stage as a whole: the system that a scene needs.
#include <algorithm>
#include <iterator>

#include "generator/specialise/specialisation.hpp"

namespace hamgen {

namespace {

std::vector<int> without(const std::vector<int>& all, std::vector<int> dropped) {
  std::ranges::sort(dropped);
  std::vector<int> kept;
  std::ranges::set_difference(all, dropped, std::back_inserter(kept));
  return kept;
}

// Variables that the scene names itself.
std::set<std::string> named_variables(const SceneFacts& facts) {
  std::set<std::string> names(facts.values.observe.begin(), facts.values.observe.end());
  for (const ObservedFormula& formula : facts.values.formulas) names.erase(formula.name);
  names.insert(facts.kept.begin(), facts.kept.end());
  return names;
}

// What they are made of after a change of variables.
std::set<std::string> in_new_variables(const LinearChange& change, const Mechanics& before,
                                       const std::set<std::string>& names) {
  const Substitution replacements = new_variables(change, before);
  std::set<std::string> result;
  for (const std::string& name : names) {
    const auto it = replacements.find(name);
    if (it == replacements.end()) result.insert(name);
    if (it != replacements.end()) collect_symbols(it->second, result);
  }
  return result;
}

// Variables that what the scene observes is computed from, and "energy"; none if it observes all
// there is.  `named` are those that it names itself.
std::set<std::string> observed_names(const Mechanics& mechanics, const Scheme& scheme,
                                     std::set<std::string> named) {
  for (const NamedExpression& each : mechanics.invariants) collect_symbols(each.value, named);
  bool energy = named.contains("energy");
  if (scheme.has_member()) {
    for (const auto& [place, entry] : scheme.member().c) energy = energy || depends_on(entry, "E0");
  }
  if (energy) named.insert("energy");
  if (energy) collect_symbols(mechanics.energy, named);
  return named;
}

// True if the change is made: C respects it.
bool change_variables(const std::optional<LinearChange>& change, Specialised& system,
                      SceneFacts& facts, std::set<std::string>& named) {
  if (!change) return false;
  std::optional<Scheme> scheme = in_new_variables(*change, system.whole_scheme);
  if (!scheme) return false;
  const bool is_symplectic = !scheme->has_member() || gauge_defect(scheme->member()).empty();
  if (!is_symplectic) return false;
  named = in_new_variables(*change, system.whole, named);
  system.whole = in_new_variables(*change, system.whole);
  system.whole_scheme = std::move(*scheme);
  facts = in_new_variables(*change, std::move(facts));
  std::ranges::copy(change->left_out, std::back_inserter(system.left_out));
  system.changes.push_back(*change);
  return true;
}

void drop_resting(const SceneFacts& facts, Specialised& system) {
  system.resting = resting(system.whole, system.whole_scheme, facts);
  if (system.resting.empty()) return;
  system.kept = without(system.kept, system.resting);
  system.left_out.push_back(to_text(system.resting, system.whole));
  system.mechanics = restrict_to(system.whole, system.kept);
  system.scheme = restrict_to(system.whole_scheme, system.kept);
}

void drop_unobserved(const std::set<std::string>& named, Specialised& system) {
  if (!system.mechanics.sums.empty()) return;  // which move all of their elements
  const Mechanics before = system.mechanics;
  const Unobserved left =
      unobserved(before, system.scheme, observed_names(before, system.scheme, named));
  if (left == Unobserved{}) return;
  std::vector<int> places;
  for (int i = 0; i < before.degrees_of_freedom; ++i) places.push_back(i);
  places = without(without(places, left.dropped), left.cyclic);
  std::ranges::move(to_text(left, before), std::back_inserter(system.left_out));
  system.mechanics = restrict_to(before, places, left);
  system.scheme = restrict_to(system.scheme, places);
  const auto in_whole = [kept = system.kept](const std::vector<int>& pairs) {
    std::vector<int> result;
    for (const int i : pairs) result.push_back(kept[static_cast<std::size_t>(i)]);
    return result;
  };
  system.left = {.dropped = in_whole(left.dropped), .cyclic = in_whole(left.cyclic)};
  system.kept = in_whole(places);
}

}  // namespace

Specialised specialise(const Model& model, Mechanics whole, Scheme scheme,
                       const std::optional<SceneFacts>& scene, Variables variables) {
  Specialised system{.given = std::move(whole),
                     .given_scheme = std::move(scheme),
                     .changes = {},
                     .whole = {},
                     .whole_scheme = {},
                     .mechanics = {},
                     .scheme = {},
                     .kept = {},
                     .resting = {},
                     .left = {},
                     .left_out = {}};
  system.whole = system.given;
  system.whole_scheme = system.given_scheme;
  SceneFacts facts = scene.value_or(SceneFacts{});
  std::set<std::string> named = named_variables(facts);
  const bool in_part = scene && !facts.sees_all && observes_parts(model, facts.values);
  if (scene && variables == Variables::changed) {
    const std::vector<int> still = resting(system.whole, system.whole_scheme, facts);
    change_variables(by_symmetry(system.whole, facts, still), system, facts, named);
    if (in_part) change_variables(by_translation(system.whole, named), system, facts, named);
  }
  system.mechanics = system.whole;
  system.scheme = system.whole_scheme;
  for (int i = 0; i < system.whole.degrees_of_freedom; ++i) system.kept.push_back(i);
  if (!scene) return system;
  drop_resting(facts, system);
  if (in_part) drop_unobserved(named, system);
  return system;
}

}  // namespace hamgen
