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

// Names that what the scene observes is computed from; none if it observes all there is.
std::set<std::string> observed_names(const Model& model, const Mechanics& mechanics,
                                     const Scheme& scheme, const SceneFacts& facts) {
  if (!observes_parts(model, facts.values)) return {};
  std::set<std::string> names(facts.values.observe.begin(), facts.values.observe.end());
  names.insert(facts.kept.begin(), facts.kept.end());
  for (const NamedExpression& each : mechanics.invariants) collect_symbols(each.value, names);
  bool energy = names.contains("energy");
  if (scheme.has_member()) {
    for (const auto& [place, entry] : scheme.member().c) energy = energy || depends_on(entry, "E0");
  }
  if (energy) names.insert("energy");
  if (energy) collect_symbols(mechanics.energy, names);
  return names;
}

void drop_resting(const SceneFacts& facts, Specialised& system) {
  system.resting = resting(system.whole, system.whole_scheme, facts);
  if (system.resting.empty()) return;
  system.kept = without(system.kept, system.resting);
  system.left_out.push_back(to_text(system.resting, system.whole));
  system.mechanics = restrict_to(system.whole, system.kept);
  system.scheme = restrict_to(system.whole_scheme, system.kept);
}

void drop_unobserved(const Model& model, const SceneFacts& facts, Specialised& system) {
  const Mechanics before = system.mechanics;
  const Unobserved left =
      unobserved(before, system.scheme, observed_names(model, before, system.scheme, facts));
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
                       const std::optional<SceneFacts>& scene) {
  Specialised system{.whole = std::move(whole),
                     .whole_scheme = std::move(scheme),
                     .mechanics = {},
                     .scheme = {},
                     .kept = {},
                     .resting = {},
                     .left = {},
                     .left_out = {}};
  system.mechanics = system.whole;
  system.scheme = system.whole_scheme;
  for (int i = 0; i < system.whole.degrees_of_freedom; ++i) system.kept.push_back(i);
  if (!scene) return system;
  drop_resting(*scene, system);
  drop_unobserved(model, *scene, system);
  return system;
}

}  // namespace hamgen
