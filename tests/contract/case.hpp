// What the contract is measured of: a scene of a model by one method.
#pragma once

#include <string>
#include <vector>

#include "generator/pipeline.hpp"
#include "generator/schemes/scheme.hpp"
#include "tests/contract/watch.hpp"

namespace hamgen::contract {

struct Case {
  std::string name;
  SourceText model;
  std::string scene = "";
  Request request = {};
  long steps = 0;  // 0: the scene's
};

// The scene's numbers, rounded to double: both codes start from them.
struct Start {
  std::vector<std::pair<std::string, double>> parameters;
  std::vector<double> state;
  double h = 0;
  long steps = 0;
};
[[nodiscard]] Start start_of(const Case& c);

// The numbers of the scheme's equations for steps of this length, none for an explicit scheme.  For
// a member of higher order they are those of the member it was raised from.
[[nodiscard]] Equations equations_of(const Scheme& scheme, int degrees_of_freedom,
                                     const Start& start, Quad h);

struct Method {
  std::string name;
  Request request = {};
};
// Every scheme of THE LIST, and what else a step can be: by other solvers, of other members, of
// higher order.
[[nodiscard]] std::vector<Method> all_methods();

// The scenes of a model that have h and steps, at most so many of them.
[[nodiscard]] std::vector<Case> scenes_of(const Model& model, const SourceText& source,
                                          const Method& method, long most_steps);

// A model of tests/contract/models.hpp, or a shipped one.
[[nodiscard]] SourceText model(const std::string& name);
// Is its force what terms of another size leave?
[[nodiscard]] bool has_cancelling_forces(const SourceText& model);
// The names of both.
[[nodiscard]] std::vector<std::string> all_models();

}  // namespace hamgen::contract
