#include "app/studies/modified_energy.hpp"

#include <algorithm>

#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "app/studies/stop.hpp"
#include "generator/verify/modified_energy.hpp"

namespace hamgen::app {
namespace {

// Ht is evaluated at about so many states of the orbit.
constexpr long samples = 400;

Rational exact(const runtime::Wide& value) {
  return Rational(from_double(value.hi) + from_double(value.lo));
}

}  // namespace

std::vector<std::size_t> ModifiedEnergy::powers() const {
  std::vector<std::size_t> result;
  for (std::size_t j = 0; j < terms.size(); ++j) {
    if (j == 0 || !terms[j].is_zero()) result.push_back(j);
  }
  return result;
}

WatchedOrbit watch_orbit(const SourceText& source, Request request, const SceneValues& scene,
                         const std::vector<Expression>& terms, StopFlag stop) {
  request.scalar = "quad";
  request.scene.reset();  // the terms are in all variables
  const Model model = read_request(source, request);
  const PluginSource plugin = generate_plugin(source, request);
  const runtime::LoadedPlugin loaded = load_integrator(plugin, {}, stop);
  runtime::Integrator integrator(loaded.library, initial_values(plugin, scene, *loaded.library));

  std::map<std::string, Rational> fixed = {{"h", *scene.h}};
  const std::vector<std::string> parameters = element_names(model.parameters);
  for (std::size_t i = 0; i < parameters.size(); ++i) fixed[parameters[i]] = scene.parameters[i];
  std::vector<std::string> names = element_names(model.coordinates);
  const std::vector<std::string> momenta = element_names(model.momenta);
  names.insert(names.end(), momenta.begin(), momenta.end());

  ModifiedEnergyWatch watch(terms, fixed);
  const auto add = [&] {
    std::map<std::string, Rational> state;
    const std::vector<runtime::Wide> z = integrator.state();
    for (std::size_t i = 0; i < names.size(); ++i) state[names[i]] = exact(z[i]);
    watch.add(state);
  };
  add();
  const long distance = std::max(1L, *scene.steps / samples);
  // So many quad steps take less than a second.
  constexpr long at_once = 4096;
  const auto advance = [&] {
    for (long left = distance; left > 0; left -= at_once) {
      if (is_stopped(stop)) return false;
      const auto status = integrator.advance(std::min(left, at_once), false).status;
      if (status != runtime::Status::done) return false;
    }
    return true;
  };
  long done = 0;
  for (; done < *scene.steps && advance(); done += distance) add();
  return {.scene = scene.name,
          .h = to_double(*scene.h),
          .steps = done,
          .variations = watch.variations()};
}

}  // namespace hamgen::app
