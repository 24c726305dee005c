// A step that an interpreted integrator takes, and the certifier of its method.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/studies/certify.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/interpreted.hpp"
#include "generator/base/source_text.hpp"

namespace hamgen::certify_test {

inline const std::string kHenonHeiles = R"(
coordinate x, y
momentum u, v
H = (u^2 + v^2)/2 + (x^2 + y^2)/2 + x^2*y - y^3/3
scene s { x = 1/10; u = 2/5; v = -1/7; h = 1/10; steps = 100 }
)";

// What certify() is asked about, alive as long as this.
struct Orbit {
  explicit Orbit(const std::string& text, Request method = {}, const std::string& h = "")
      : source(make_source("orbit.ham", "system run\n" + text)), request(std::move(method)) {
    plugin = generate_plugin(source, request);
    scheme = request_scheme(source, request);
    SceneRequest wanted;
    if (!h.empty()) wanted.h = h;
    scene = app::complete_scene(plugin.model, wanted);
    library = app::interpreted_integrator(source, request, plugin).library;
    start = app::initial_values(plugin, scene, *library);
  }

  [[nodiscard]] app::Certificate certify(long steps, long every = 1) {
    scene.steps = steps;
    return app::certify({.plugin = &plugin,
                         .library = library,
                         .scene = &scene,
                         .scheme = &scheme,
                         .start = &start,
                         .every = every});
  }

  SourceText source;
  Request request;
  PluginSource plugin;
  Scheme scheme;
  SceneValues scene;
  std::shared_ptr<const runtime::Library> library;
  runtime::InitialValues start;
};

}  // namespace hamgen::certify_test
