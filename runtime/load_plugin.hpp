// From the text of a plugin to the loaded plugin: the one path that the command and the library
// interface share.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/cache.hpp"
#include "runtime/compile.hpp"
#include "runtime/compiler.hpp"
#include "runtime/library.hpp"

namespace hamgen::runtime {

// A plugin, and how it came to be there.
struct LoadedPlugin {
  std::shared_ptr<const Library> library;  // never null
  std::string key;                         // of the cache
  std::string optimisation;                // what the compiler was asked for, as "-O3"
  bool from_cache = false;                 // else it was compiled
  double compile_seconds = 0.0;            // 0 from the cache
  std::vector<std::string> warnings;       // about the cache; one sentence each
};

// Takes the object from the cache or compiles it and puts it there.  A cache that cannot be used
// costs a warning, and the object is compiled in a private directory that does not outlive the
// call.  A compilation that fails leaves nothing.  Throws ToolError.
[[nodiscard]] LoadedPlugin load_plugin(const PluginSource& source, const Compiler& compiler,
                                       const CompileOptions& options, const Cache& cache);

}  // namespace hamgen::runtime
