// From emitted text to a loaded integrator, as every command that runs one does it.
#pragma once

#include <string>

#include "app/studies/stop.hpp"
#include "generator/pipeline.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::app {

// Compiles the plugin, or takes it from the cache, and loads it; `stop` gives up the compilation.
// `compiler` is empty for the default.  Throws ToolError.
[[nodiscard]] runtime::LoadedPlugin load_integrator(const PluginSource& plugin,
                                                    const std::string& compiler, StopFlag stop);

}  // namespace hamgen::app
