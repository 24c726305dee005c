// From emitted text to a loaded integrator, as every command that runs one does it.
#pragma once

#include <limits>
#include <string>

#include "app/studies/stop.hpp"
#include "generator/pipeline.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::app {

// What a user says of the compiler.
struct CompilerChoice {
  std::string program;    // with flags of its own, if any; "": $CXX, or what is there
  std::string flags;      // further ones
  bool portable = false;  // what it makes is for other machines than this one, too

  bool operator==(const CompilerChoice&) const = default;
};

// The compiler to use.  It compiles for the processor it runs on unless the choice says otherwise
// or its flags name one.  Throws UsageError if flags that came with it would change what the
// arithmetic means, ToolError if it is not there.
[[nodiscard]] runtime::Compiler chosen_compiler(const CompilerChoice& choice);

// What the compiler is asked for if so many steps are all that is taken: "-O0" to "-O3".
[[nodiscard]] std::string optimisation_for(const PluginSource& plugin, double steps);

// Of so many orbits together; infinite if their number of steps is computed from what varies.
[[nodiscard]] double steps_of_all(const Model& model, const SceneRequest& request,
                                  const SceneValues& scene, const std::vector<std::string>& varied,
                                  double orbits);

// Compiles the plugin, or takes it from the cache, and loads it; `stop` gives up the compilation.
// Few steps are not worth the time of an optimiser.  Throws ToolError, and what chosen_compiler
// throws.
[[nodiscard]] runtime::LoadedPlugin load_integrator(
    const PluginSource& plugin, const CompilerChoice& compiler, StopFlag stop,
    double steps = std::numeric_limits<double>::infinity());

// Of the code alone, the compiler and its flags: two plugins with the same digest do the same,
// wherever their model is.  Throws as chosen_compiler.
[[nodiscard]] std::string digest_of_code(const PluginSource& plugin,
                                         const CompilerChoice& compiler);

}  // namespace hamgen::app
