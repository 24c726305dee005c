// The cache of compiled plugins and of what was computed with them: one file KEY.so or KEY.txt
// each, and KEY.about that says what it is of, in a directory nobody else can write.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/compile.hpp"

namespace hamgen::runtime {

// A directory that is fit to be one, or why it is not.
struct Cache {
  std::filesystem::path directory;  // absolute; empty if there is none
  std::string problem;              // why it is not used, as a warning; empty if it is usable

  // Is there no problem?
  [[nodiscard]] bool usable() const { return problem.empty(); }
};

// $HAMGEN_CACHE, else $XDG_CACHE_HOME/hamgen, else $HOME/.cache/hamgen; empty if none is set.
[[nodiscard]] std::filesystem::path default_cache_directory();

// Creates the directory with mode 0700 if it is missing and checks it.  Never throws for a bad
// directory: `problem` says what is wrong and the callers go on without a cache.
[[nodiscard]] Cache open_cache(const std::filesystem::path& directory = default_cache_directory());

// What makes a directory unfit: a link, not a directory, of another owner, writable by others.
[[nodiscard]] std::string directory_problem(const std::filesystem::path& directory);

// 64 hexadecimal digits: SHA-256 of the texts, the compiler's identity, the flags, the version of
// the plugin interface and, for -march=native and the like, the processor.
[[nodiscard]] std::string cache_key(const PluginSource& source, const Compiler& compiler,
                                    const CompileOptions& options);

// The object of that key if it is there, ours and undamaged.  Marks it as used now.
[[nodiscard]] std::optional<std::filesystem::path> find_object(const Cache& cache,
                                                               const std::string& key);

// Moves an object, which must lie in the cache's file system, to its place.  Throws ToolError.
std::filesystem::path publish_object(const Cache& cache, const std::string& key,
                                     const std::filesystem::path& object);

// The same for a text, such as a reference solution.  A damaged one is not found.
[[nodiscard]] std::optional<std::string> find_text(const Cache& cache, const std::string& key);
// Throws ToolError.
void publish_text(const Cache& cache, const std::string& key, std::string_view text);

// What an entry is of, for people.  A line end in a field becomes a blank.
struct CacheRecord {
  std::string model;   // the system's name
  std::string scheme;  // the method's
  std::string made;    // the day, 2026-01-31; filled in where it is written
  bool operator==(const CacheRecord&) const = default;
};

// Beside an entry, if there is none yet.  Throws ToolError.
void publish_record(const Cache& cache, const std::string& key, const CacheRecord& record);

// Nothing if there is none, as of an entry of an earlier version, or it is damaged or no record.
[[nodiscard]] std::optional<CacheRecord> find_record(const Cache& cache, const std::string& key);

// A file of the cache.
struct CacheEntry {
  std::string key;                            // 64 hexadecimal digits
  std::string extension;                      // ".so" or ".txt"
  std::uintmax_t bytes = 0;                   // of the file
  std::filesystem::file_time_type last_used;  // when it was found last
};

// What was removed.
struct CacheRemoval {
  std::size_t entries = 0;   // their number
  std::uintmax_t bytes = 0;  // and their size
};

inline constexpr std::uintmax_t kCacheLimit = 256u << 20;  // bytes

// Most recently used first.  All three leave files alone that hamgen did not make.
[[nodiscard]] std::vector<CacheEntry> list_cache(const Cache& cache);

// Removes everything, also what interrupted compilations left, and records without an entry.
CacheRemoval clear_cache(const Cache& cache);

// Removes the least recently used entries until `limit` bytes remain, and left-overs older than a
// day.
CacheRemoval prune_cache(const Cache& cache, std::uintmax_t limit = kCacheLimit);

}  // namespace hamgen::runtime
