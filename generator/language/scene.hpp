// What a scene means in numbers, once the user's overrides are applied.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "generator/language/model.hpp"

namespace hamgen {

// Values are expressions, as on the command line.
struct SceneRequest {
  std::string scene = {};                                         // empty: the first, if any
  std::vector<std::pair<std::string, std::string>> set = {};      // --set NAME=VALUE
  std::vector<std::pair<std::string, std::string>> initial = {};  // --initial NAME=VALUE
  // --reference NAME=VALUE: a variable or a parameter of a point that is not a run's.
  std::vector<std::pair<std::string, std::string>> reference = {};
  std::optional<std::string> h = {};
  std::optional<std::string> steps = {};
  std::optional<std::string> time = {};     // --time T: as many whole steps as it has room for
  std::optional<std::string> observe = {};  // --observe LIST
};

// A quantity that a scene defines to look at it.
struct ObservedFormula {
  std::string name;
  NodePtr value;
  std::string text;
};

// Initial data of a run.  q, p, parameters in state order (element_names); exact rationals, or
// 50-digit values of constants such as sqrt(2).
struct SceneValues {
  std::string name;
  std::vector<Rational> q;
  std::vector<Rational> p;
  std::vector<Rational> parameters;
  std::optional<Rational> h;
  std::optional<long> steps;
  std::optional<long> every;
  // "energy", invariants, elements of the state, names of formulas; empty: all there is.
  std::vector<std::string> observe = {};
  std::vector<ObservedFormula> formulas = {};
  // Computed for the run itself: not observed, and in none of its results.
  std::vector<ObservedFormula> watched = {};
};

// Is it observed?
[[nodiscard]] bool observes(const SceneValues& scene, const std::string& name);
// Does the list name a part of the state or a formula?  Then what it does not name is not observed;
// else the state is, too.
[[nodiscard]] bool observes_parts(const Model& model, const SceneValues& scene);

// Parameters first (defaults, then the scene's, then --set, each able to use those before), then
// the state.  A variable nobody sets is 0.  Throws UsageError for a wrong option value (unknown
// name with its nearest, nan, inf, a wrong count, h = 0, steps < 0 or > 1e15), ModelError for a
// wrong line of the scene.
[[nodiscard]] SceneValues scene_values(const Model& model, const SceneRequest& request);
// Of one of the model's scenes, without overrides.
[[nodiscard]] SceneValues values_of_scene(const Model& model, const Scene& scene);
// The model's sizes where they are numbers of formulas.
[[nodiscard]] std::map<std::string, Rational> numbers_of_sizes(const Model& model);
// Those of the declarations, element by element.
[[nodiscard]] std::vector<Rational> default_parameters(const Model& model);

// These names, and the parameters and variables, h and steps, whose values the run computes from
// them.
[[nodiscard]] std::set<std::string> names_computed_from(const Model& model,
                                                        const SceneRequest& request,
                                                        const std::vector<std::string>& names);

// A constant expression over named values; throws ModelError where it is undefined or not real.
[[nodiscard]] Rational evaluate_constant(const NodePtr& node, const SourceText& source,
                                         const std::map<std::string, Rational>& values);

}  // namespace hamgen
