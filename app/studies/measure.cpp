#include "app/studies/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "app/studies/measure_tangent.hpp"
#include "runtime/integrator.hpp"

namespace hamgen::app {
namespace {

constexpr long kOrbit = 10000;  // steps along which invariants are watched

std::vector<InvariantDefect> invariant_defects(const PluginSource& plugin,
                                               const runtime::LoadedPlugin& loaded,
                                               const runtime::InitialValues& start, long steps) {
  if (plugin.invariant_names.empty()) return {};
  runtime::Integrator integrator(loaded.library, start);
  std::vector<InvariantDefect> defects;
  const std::vector<runtime::Wide> before = integrator.invariants();
  for (std::size_t i = 0; i < before.size(); ++i)
    defects.push_back({.name = plugin.invariant_names[i], .initial = before[i].hi + 0.0});  // no -0
  const long most = std::min(steps, kOrbit);
  for (long done = 0; done < most;) {
    const long now = std::min(10L, most - done);
    if (integrator.advance(now, false).status != runtime::Status::done) break;
    done += now;
    const std::vector<runtime::Wide> after = integrator.invariants();
    for (std::size_t i = 0; i < defects.size(); ++i) {
      const double change = std::abs(runtime::difference(after[i], before[i]));
      // Once not a number, always: the maximum keeps its first argument.
      defects[i].largest = std::isnan(change) ? change : std::max(defects[i].largest, change);
      defects[i].steps = done;
    }
  }
  return defects;
}

}  // namespace

Measured measure(const SourceText& source, Request request, const SceneRequest& wanted,
                 bool symmetric, StopFlag stop) {
  request.tangent = true;
  const PluginSource plugin = generate_plugin(source, request);
  const SceneValues scene = complete_scene(plugin.model, wanted, "");
  // Those of the orbit, and as many again for difference quotients and the way back.
  const double steps = 2.0 * static_cast<double>(std::min(*scene.steps, kOrbit));
  const runtime::LoadedPlugin loaded = load_integrator(plugin, {}, stop, steps);
  const runtime::InitialValues start = initial_values(plugin, scene, *loaded.library);
  Proof proof;
  if (loaded.library->plugin().tangent != nullptr) {
    proof = measure_tangent(loaded, start, symmetric);
  } else {
    proof.push_back({"tangent map", Verdict::not_decided, plugin.without_tangent});
  }
  return {std::move(proof), invariant_defects(plugin, loaded, start, *scene.steps)};
}

Finding finding(const InvariantDefect& defect) {
  const std::string property = defect.name + " measured";
  if (!std::isfinite(defect.initial))
    return {property, Verdict::not_decided, "not defined at the initial state"};
  if (!std::isfinite(defect.largest))
    return {property, Verdict::measured,
            fmt::format("{:.6g} at first, not defined later within {} steps of the scene",
                        defect.initial, defect.steps)};
  return {property, Verdict::measured,
          fmt::format("changes by at most {:.2e} from {:.6g} in {} steps of the scene",
                      defect.largest, defect.initial, defect.steps)};
}

}  // namespace hamgen::app
