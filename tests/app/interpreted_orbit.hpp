// Orbits of short models without a compiler.
#pragma once

#include <memory>
#include <string>

#include "app/studies/initial_data.hpp"
#include "app/studies/interpreted.hpp"
#include "generator/base/source_text.hpp"

namespace hamgen::app_test {

struct InterpretedOrbit {
  SourceText source;
  PluginSource plugin;
  std::shared_ptr<const runtime::Library> library;
  runtime::InitialValues start;
};

// The first scene of the model.
inline std::shared_ptr<InterpretedOrbit> interpreted_orbit(const std::string& text,
                                                           const std::string& scheme,
                                                           const std::string& h,
                                                           const std::string& scalar = "") {
  auto orbit = std::make_shared<InterpretedOrbit>();
  orbit->source = make_source("model.ham", text);
  Request request;
  request.scheme = scheme;
  request.scalar = scalar;
  orbit->plugin = generate_plugin(orbit->source, request);
  orbit->library = app::interpreted_integrator(orbit->source, request, orbit->plugin).library;
  const SceneValues scene =
      app::complete_scene(orbit->plugin.model, {.h = h, .steps = std::string("1")});
  orbit->start = app::initial_values(orbit->plugin, scene, *orbit->library);
  return orbit;
}

}  // namespace hamgen::app_test
