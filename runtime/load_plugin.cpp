#include "runtime/load_plugin.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

#include "runtime/temporary_directory.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;

struct BuildDirectory {
  TemporaryDirectory directory;
  bool in_cache = false;
};

// The sources written in a directory inside the cache, from where the object can be renamed to its
// place; if that fails (a full or read-only disk), in a private one elsewhere.
BuildDirectory prepare(const PluginSource& source, const Cache& cache,
                       std::vector<std::string>& warnings) {
  if (cache.usable()) {
    try {
      BuildDirectory build{.directory = TemporaryDirectory(cache.directory, ".build-"),
                           .in_cache = true};
      write_sources(source, build.directory.path());
      return build;
    } catch (const ToolError& error) {
      warnings.push_back(std::string("the cache is not used: ") + error.what());
    }
  }
  BuildDirectory build{.directory = private_directory(), .in_cache = false};
  write_sources(source, build.directory.path());
  return build;
}

// What the entry is of, where that is known.
void record(const Cache& cache, const std::string& key, const PluginSource& source) {
  if (source.model.empty()) return;
  publish_record(cache, key, {.model = source.model, .scheme = source.scheme, .made = {}});
}

std::shared_ptr<const Library> load_cached(const Cache& cache, const std::string& key) {
  const std::optional<fs::path> object = find_object(cache, key);
  if (!object) return nullptr;
  try {
    return std::make_shared<const Library>(*object);
  } catch (const ToolError&) {
    // Removed meanwhile by another process, or made for libraries this system no longer has.
    return nullptr;
  }
}

// Not even the object of a small model, and what the linker writes beside it, fits surely.
bool is_nearly_full(const fs::path& directory) {
  constexpr std::uintmax_t kEnough = 16 << 20;
  std::error_code failed;
  const fs::space_info space = fs::space(directory, failed);
  return !failed && space.available < kEnough;
}

struct Built {
  BuildDirectory build;
  fs::path object;
};

// In the cache; once more elsewhere if that has no room for what a compiler writes.
Built compile(const PluginSource& source, const Compiler& compiler, const CompileOptions& options,
              const Cache& cache, std::vector<std::string>& warnings) {
  BuildDirectory build = prepare(source, cache, warnings);
  try {
    fs::path object = compile_sources(source, compiler, options, build.directory.path());
    return {.build = std::move(build), .object = std::move(object)};
  } catch (const ToolError&) {
    if (!build.in_cache || !is_nearly_full(cache.directory)) throw;
  }
  warnings.push_back(
      fmt::format("the cache '{}' is not used: its disk is nearly full", cache.directory.string()));
  BuildDirectory elsewhere{.directory = private_directory(), .in_cache = false};
  write_sources(source, elsewhere.directory.path());
  fs::path object = compile_sources(source, compiler, options, elsewhere.directory.path());
  return {.build = std::move(elsewhere), .object = std::move(object)};
}

}  // namespace

LoadedPlugin load_plugin(const PluginSource& source, const Compiler& compiler,
                         const CompileOptions& options, const Cache& cache) {
  LoadedPlugin loaded{.library = nullptr,
                      .key = {},
                      .optimisation = {},
                      .from_cache = false,
                      .compile_seconds = 0.0,
                      .warnings = {}};
  // The directory may have changed since the cache was opened.
  Cache checked = cache;
  if (checked.usable()) checked.problem = directory_problem(checked.directory);
  if (!checked.usable()) loaded.warnings.push_back(checked.problem);

  // One that was optimised more is as good: it takes the same steps.
  CompileOptions more = options;
  more.optimisation = CompileOptions().optimisation;
  for (const CompileOptions& each : {more, options}) {
    loaded.key = cache_key(source, compiler, each);
    loaded.optimisation = optimisation_of(compiler, each);
    loaded.library = load_cached(checked, loaded.key);
    if (loaded.library != nullptr) break;
  }
  loaded.from_cache = loaded.library != nullptr;
  if (loaded.from_cache) {
    try {
      record(checked, loaded.key, source);  // of an entry that has none yet
    } catch (const ToolError&) {
      // It is found without.
    }
    return loaded;
  }

  const auto begin = std::chrono::steady_clock::now();
  const auto [build, object] = compile(source, compiler, options, checked, loaded.warnings);
  loaded.compile_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  // Loaded before it is published: what cannot be loaded is not kept.
  loaded.library = std::make_shared<const Library>(object);
  if (build.in_cache) {
    try {
      publish_object(checked, loaded.key, object);
      record(checked, loaded.key, source);
      prune_cache(checked);
    } catch (const ToolError& error) {
      loaded.warnings.push_back(std::string("not kept in the cache: ") + error.what());
    }
  }
  return loaded;
}

}  // namespace hamgen::runtime
