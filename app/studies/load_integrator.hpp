// From emitted text to a loaded integrator, as every command that runs one does it.
#pragma once

#include <string>

#include "generator/pipeline.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::app {

// Compiles the plugin, or takes it from the cache, and loads it; an interrupt stops the compiler.
// `compiler` is empty for the default.  Throws ToolError.
[[nodiscard]] runtime::LoadedPlugin load_integrator(const PluginSource& plugin,
                                                    const std::string& compiler);

}  // namespace hamgen::app
