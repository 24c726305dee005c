// From the text of a plugin to a shared object in a given directory.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/compiler.hpp"

namespace hamgen::runtime {

// A header beside the main text.
struct SourceFile {
  std::string name;  // no directories
  std::string text;  // all of it
};

// The main text may `#include "plugin.h"`, which is always there, and its own headers by name.
struct PluginSource {
  std::string text;                 // one translation unit of C++20
  std::vector<SourceFile> headers;  // that it includes by name
  std::string name = "plugin.cpp";  // shown in the compiler's messages
  bool uses_eigen = false;          // CompileOptions::eigen_include is on its path
  bool uses_quadmath = false;       // libquadmath is linked
  std::string model = {};           // its name, for the list of the cache only; may be empty
  std::string scheme = {};          // the same
};

// How a plugin is compiled.
struct CompileOptions {
  std::string optimisation = "-O3";      // unless the compiler's own arguments ask for another
  std::vector<std::string> extra_flags;  // after the default ones
  std::string eigen_include = "/usr/include/eigen3";                 // a directory
  std::chrono::milliseconds time_limit = std::chrono::seconds(120);  // of wall clock
  std::uint64_t memory_limit = std::uint64_t{8} << 30;  // bytes, of each process of the compiler
  const std::atomic<bool>* stop = nullptr;              // gives up the compilation when set
};

// The compiler's own last argument that asks for one, or else what the options ask for: "-O3".
[[nodiscard]] std::string optimisation_of(const Compiler& compiler, const CompileOptions& options);

// The flags for a source, without file names.  Throws ToolError if an extra flag would change what
// the arithmetic means (runtime/arithmetic.hpp).
[[nodiscard]] std::vector<std::string> compile_flags(const PluginSource& source,
                                                     const Compiler& compiler,
                                                     const CompileOptions& options);

// Writes the texts into the directory.  Throws ToolError.
void write_sources(const PluginSource& source, const std::filesystem::path& directory);

// Compiles what write_sources wrote and returns the path of the object, in the same directory.
// Throws ToolError with the command, the exit status and the end of the compiler's output, or if an
// argument that came with the compiler would change what the arithmetic means.
[[nodiscard]] std::filesystem::path compile_sources(const PluginSource& source,
                                                    const Compiler& compiler,
                                                    const CompileOptions& options,
                                                    const std::filesystem::path& directory);

}  // namespace hamgen::runtime
