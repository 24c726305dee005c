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

Rational value_of(const std::string& name, const Model& model, const SceneValues& scene) {
  const std::vector<std::string> names = element_names(model.parameters);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name || names[i].starts_with(name + "[")) return scene.parameters[i];
  }
  const std::vector<std::string> momenta = element_names(model.momenta);
  return scene.p.at(at(static_cast<int>(std::ranges::find(momenta, name) - momenta.begin())));
}

template <class Real>
std::vector<Real> parameters_of(const StepCode& code, const Model& model,
                                const SceneValues& scene) {
  std::vector<Real> values;
  for (const std::string& name : code.parameters)
    values.push_back(static_cast<Real>(to_double(value_of(name, model, scene))));
  return values;
}

// The largest difference of a step, in units of rounding of the largest component.  The whole step
// is in quad, from the state and the carry of the other one; what was left out rests.
double worst_step(const SourceText& source, const Request& whole, const Request& special,
                  const SceneValues& scene, int steps) {
  const Model model = read_request(source, special);
  const PluginSource plugin = generate_plugin(source, special);
  const StepCode code = make_step_code(source, special);
  const StepCode all = make_step_code(source, whole);
  const std::size_t n = scene.q.size();
  const std::size_t m = plugin.kept.size();
  std::vector<double> start(2 * m);
  std::vector<Quad> rest(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    rest[i] = to_double(scene.q[i]);
    rest[n + i] = to_double(scene.p[i]);
  }
  for (std::size_t i = 0; i < m; ++i) {
    start[i] = to_double(scene.q[at(plugin.kept[i])]);
    start[m + i] = to_double(scene.p[at(plugin.kept[i])]);
  }
  const double h = to_double(*scene.h);
  Interpreter<double> run(code, parameters_of<double>(code, model, scene), h, start);
  Interpreter<Quad> exact(all, parameters_of<Quad>(all, model, scene), Quad(h), rest);
  const auto embedded = [&](const std::vector<double>& values, bool carry) {
    std::vector<Quad> result = carry ? std::vector<Quad>(2 * n) : rest;
    for (std::size_t i = 0; i < m; ++i) {
      result[at(plugin.kept[i])] = values[i];
      result[n + at(plugin.kept[i])] = values[m + i];
    }
    return result;
  };
  double worst = 0;
  for (int step = 0; step < steps; ++step) {
    exact.reset(embedded(run.state(), false), embedded(run.carry(), true));
    if (!run.step().converged || !exact.step().converged) return HUGE_VAL;
    double size = 0;
    for (const double x : run.state()) size = std::max(size, std::abs(x));
    const std::vector<Quad> state = embedded(run.state(), false);
    const std::vector<Quad> carry = embedded(run.carry(), true);
    for (std::size_t i = 0; i < 2 * n; ++i) {
      const bool unknown =
          std::ranges::find(plugin.unobserved, static_cast<int>(i)) != plugin.unobserved.end();
      if (unknown) continue;
      const Quad error = (state[i] - exact.state()[i]) + (carry[i] - exact.carry()[i]);
      worst = std::max(worst, std::abs(static_cast<double>(error)) / (size * 0x1p-52));
    }
  }
  return worst;
}

// One of each kind, or all of them where HAMGEN_EVERY_SCHEME is set: `ctest -C full` does.
std::vector<std::string> compared_schemes() {
  if (std::getenv("HAMGEN_EVERY_SCHEME") == nullptr)
    return {"implicit-midpoint", "symplectic-euler-a", "stormer-verlet",
            "yoshida-4",         "suzuki-4-verlet",    "gauss-4"};
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
      if (show_stage(source, special(midpoint.scheme), "program") ==
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
