// From emitted text to a loaded integrator, as every command that runs one does it.
#pragma once

#include <string>

#include "app/studies/stop.hpp"
#include "generator/pipeline.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::app {

// The compiler to use; `choice` is --compiler, empty for the default.  Throws UsageError if flags
// that came with it would change what the arithmetic means, ToolError if it is not there.
[[nodiscard]] runtime::Compiler chosen_compiler(const std::string& choice);

// Compiles the plugin, or takes it from the cache, and loads it; `stop` gives up the compilation.
// `compiler` is as for chosen_compiler.  Throws ToolError, and what chosen_compiler throws.
[[nodiscard]] runtime::LoadedPlugin load_integrator(const PluginSource& plugin,
                                                    const std::string& compiler, StopFlag stop);

// Of the code alone, the compiler and its flags: two plugins with the same digest do the same,
// wherever their model is.  Throws as chosen_compiler.
[[nodiscard]] std::string digest_of_code(const PluginSource& plugin, const std::string& compiler);

}  // namespace hamgen::app
