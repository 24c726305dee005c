// From emitted text to a loaded integrator, as every command that runs one does it.
#pragma once

#include <string>

#include "app/studies/stop.hpp"
#include "generator/pipeline.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::app {

// What a user says of the compiler in one text, "" for the defaults: a program with flags of its
// own, further flags, and whether what it makes is for other machines than this one, too.
[[nodiscard]] std::string compiler_choice(const std::string& program, const std::string& flags,
                                          bool portable);

// The compiler to use, by compiler_choice or the value of --compiler.  It compiles for the
// processor it runs on unless that is said or the flags name one.  Throws UsageError if flags
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
