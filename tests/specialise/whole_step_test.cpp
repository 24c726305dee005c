// The step that a scene is run with against the step of the whole system: every scene of every
// model from which something was left out, by every scheme, interpreted.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "generator/base/diagnostic.hpp"
#include "generator/interpreter/interpreter.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "tests/specialise/specialised_request.hpp"

namespace hamgen {
namespace {

namespace fs = std::filesystem;
using Quad = __float128;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// What of a sum of variables does not depend on the step.
Rational at_start(const StateMap::Sum& sum, const SceneValues& scene) {
  Rational total = 0;
  const auto n = static_cast<int>(scene.q.size());
  for (const auto& [i, factor] : sum.at_start)
    total += factor * (i < n ? scene.q[at(i)] : scene.p[at(i - n)]);
  return total;
}

Rational value_of(const std::string& name, const PluginSource& plugin, const SceneValues& scene) {
  const std::vector<std::string> names = element_names(plugin.model.parameters);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name || names[i].starts_with(name + "[")) return scene.parameters[i];
  }
  return at_start(plugin.state.constants.at(name), scene);
}

template <class Real>
std::vector<Real> parameters_of(const Program& code, const PluginSource& plugin,
                                const SceneValues& scene) {
  std::vector<Real> values;
  for (const auto& [name, unit, comment, value] : code.environment.parameters)
    values.push_back(static_cast<Real>(to_double(value_of(name, plugin, scene))));
  return values;
}

// The model's variables that the step's are, from its state or from what rounding took of it.
std::vector<Quad> embedded(const StateMap& map, const std::vector<double>& values,
                           const SceneValues& scene, bool carry) {
  std::vector<Quad> result;
  for (const StateMap::Sum& sum : map.model) {
    Quad value = carry ? 0 : to_double(at_start(sum, scene));
    for (const auto& [place, factor] : sum.of)
      value +=
          Quad(values[at(place)]) * Quad(factor.get_num().get_d()) / Quad(factor.get_den().get_d());
    result.push_back(value);
  }
  return result;
}

// The largest difference of a step, in units of rounding of the largest component.  The whole step
// is in quad, from the state and the carry of the other one; what was left out rests.
double worst_step(const SourceText& source, const Request& whole, const Request& special,
                  const SceneValues& scene, int steps) {
  const PluginSource plugin = generate_plugin(source, special);
  const StateMap& map = plugin.state;
  const Program code = make_program(source, special);
  const Program all = make_program(source, whole);
  std::vector<double> start;
  for (const StateMap::Sum& sum : map.step) start.push_back(to_double(at_start(sum, scene)));
  const double h = to_double(*scene.h);
  Interpreter<double> run(code, parameters_of<double>(code, plugin, scene), h, start);
  Interpreter<Quad> exact(all, parameters_of<Quad>(all, plugin, scene), Quad(h),
                          embedded(map, start, scene, false));
  double worst = 0;
  for (int step = 0; step < steps; ++step) {
    exact.reset(embedded(map, run.state(), scene, false), embedded(map, run.carry(), scene, true));
    if (!run.step().converged || !exact.step().converged) return HUGE_VAL;
    const std::vector<Quad> state = embedded(map, run.state(), scene, false);
    const std::vector<Quad> carry = embedded(map, run.carry(), scene, true);
    double size = 0;
    for (const Quad x : state) size = std::max(size, std::abs(static_cast<double>(x)));
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (!map.model[i].known) continue;
      const Quad error = (state[i] - exact.state()[i]) + (carry[i] - exact.carry()[i]);
      worst = std::max(worst, std::abs(static_cast<double>(error)) / (size * 0x1p-52));
    }
  }
  return worst;
}

// One of each kind, or all of them where HAMGEN_EVERY_SCHEME is set: `ctest -C full` does.
std::vector<std::string> compared_schemes() {
  if (std::getenv("HAMGEN_EVERY_SCHEME") == nullptr)
    return {"implicit-midpoint", "symplectic-euler-a", "suzuki-4-verlet", "gauss-4"};
  std::vector<std::string> names;
  for (const Scheme& scheme : all_schemes()) names.push_back(scheme.name);
  return names;
}

// As the two scalars in EveryScheme.OfEveryModelIsTheSameStepInDoubleAndInQuad: rounding errors
// times the norm of the inverse of the step's matrix, which no scene here makes large; 16 is what
// a step may lose.
TEST(EveryScene, IsRunWithTheStepOfTheWholeSystem) {
  int compared = 0;
  for (const auto& entry :
       fs::directory_iterator(std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians")) {
    const SourceText source = read_source(entry.path().string());
    for (const Scene& scene : read_request(source, {}).scenes) {
      const auto special = [&](const std::string& scheme) {
        return for_scene(source, {.request = {.scheme = scheme}, .scene = scene.name});
      };
      const Request midpoint{.scheme = "implicit-midpoint"};
      if (show_stage(source, special(midpoint.scheme.text()), "program") ==
          show_stage(source, midpoint, "program"))
        continue;
      for (const std::string& scheme : compared_schemes()) {
        // Steps of w h = 100 multiply rounding by as much, and explicit ones explode.
        if (entry.path().stem() == "harmonic" && scene.name == "stiff") continue;
        try {
          const Request request = special(scheme);
          const double worst =
              worst_step(source, {.scheme = scheme}, request, request.scene->values, 4);
          EXPECT_LE(worst, 16) << entry.path().stem() << " " << scene.name << " " << scheme;
          ++compared;
        } catch (const UsageError&) {
          continue;  // the scheme needs what this H does not have
        }
      }
    }
  }
  EXPECT_GE(compared, 40);
}

// A start off the plane that the step was made for is seen.
TEST(EveryScene, AWrongStartIsSeen) {
  const SourceText source = make_source(
      "m.ham",
      "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + x^4 + x^2*y^2\n"
      "scene s { x = 1; h = 0.1; steps = 1 }\nscene off { x = 1; y = 0.1; h = 0.1; steps = 1 }\n");
  const Request special = for_scene(source, {.scene = "s"});
  const Request off = for_scene(source, {.scene = "off"});
  EXPECT_LE(worst_step(source, {}, special, special.scene->values, 4), 16);
  EXPECT_LE(worst_step(source, {}, off, off.scene->values, 4), 16);
  EXPECT_GE(worst_step(source, {}, special, off.scene->values, 4), 1e6);
}

}  // namespace
}  // namespace hamgen
