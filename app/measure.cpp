#include "app/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/initial_data.hpp"
#include "app/load_integrator.hpp"
#include "app/measure_tangent.hpp"
#include "runtime/integrator.hpp"

namespace hamgen::app {
namespace {

void measure_invariants(const PluginSource& plugin, const runtime::LoadedPlugin& loaded,
                        const runtime::InitialValues& start, long steps, Proof& proof) {
  if (plugin.invariant_names.empty()) return;
  runtime::Integrator integrator(loaded.library, start);
  const std::vector<double> before = integrator.invariants();
  std::vector<double> worst(before.size(), 0.0);
  long done = 0;
  for (const long most = std::min(steps, 10000L); done < most; done += 10) {
    const long now = std::min(10L, most - done);
    if (integrator.advance(now, false).status != runtime::Status::done) break;
    const std::vector<double> after = integrator.invariants();
    for (std::size_t i = 0; i < worst.size(); ++i) {
      worst[i] = std::max(worst[i], std::abs(after[i] - before[i]));
    }
  }
  for (std::size_t i = 0; i < worst.size(); ++i) {
    proof.push_back({plugin.invariant_names[i] + " measured", Verdict::not_decided,
                     fmt::format("changes by at most {:.2e} from {:.6g} in {} steps of the scene",
                                 worst[i], before[i], done)});
  }
}

}  // namespace

Proof measure(const SourceText& source, Request request, const std::string& scene_name,
              bool symmetric) {
  request.tangent = true;
  const PluginSource plugin = generate_plugin(source, request);
  SceneRequest wanted;
  wanted.scene = scene_name;
  const SceneValues scene = complete_scene(plugin.model, wanted);
  const runtime::LoadedPlugin loaded = load_integrator(plugin, "");
  const runtime::InitialValues start = initial_values(plugin, scene, *loaded.library);
  Proof proof;
  if (loaded.library->plugin().tangent != nullptr) {
    proof = measure_tangent(loaded, start, symmetric);
  } else {
    proof.push_back({"tangent map", Verdict::not_decided,
                     "emitted for sums that are written out, and with --order R where Newton's "
                     "iteration takes the Hessian of K itself"});
  }
  measure_invariants(plugin, loaded, start, scene.steps.value_or(1000), proof);
  return proof;
}

}  // namespace hamgen::app
