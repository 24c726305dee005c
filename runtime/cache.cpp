#include "runtime/cache.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include "runtime/atomic_file.hpp"
#include "runtime/plugin.h"
#include "runtime/plugin_header.hpp"
#include "runtime/sha256.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;

// Note [seal]
// An object ends with a line that holds the hash of its key and its content.  ELF ignores what
// follows its tables, so content and hash are published by one rename.  It catches truncation and
// decay, whose price would be a SIGBUS after dlopen; against other users there are owner and mode.
constexpr std::string_view kSealName = "\nhamgen-sha256:";
constexpr std::size_t kSealSize = kSealName.size() + 64 + 1;

std::string seal(const std::string& key, std::string_view content) {
  Sha256 hash;
  hash.update_field(key);
  hash.update_field(content);
  return fmt::format("{}{}\n", kSealName, hash.hex());
}

bool is_intact(const std::string& key, std::string_view object) {
  if (object.size() < kSealSize) return false;
  const std::string_view content = object.substr(0, object.size() - kSealSize);
  return object.substr(content.size()) == seal(key, content);
}

bool is_key(std::string_view text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_left_over(const fs::directory_entry& entry) {
  return entry.path().filename().string().starts_with(".build-");
}

fs::path object_path(const Cache& cache, const std::string& key) {
  return cache.directory / (key + ".so");
}

fs::path text_path(const Cache& cache, const std::string& key) {
  return cache.directory / (key + ".txt");
}

constexpr std::string_view kRecordEnding = ".about";
constexpr std::uintmax_t kLargestRecord = 4096;  // bytes

fs::path record_path(const Cache& cache, const std::string& key) {
  return cache.directory / (key + std::string(kRecordEnding));
}

std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text.substr(0, kLargestRecord / 4);
}

bool is_record(const fs::directory_entry& entry) {
  return entry.path().extension() == kRecordEnding && is_key(entry.path().stem().string());
}

// The sealed file, with its seal, if it is there, ours and undamaged; marks it as used now.
std::optional<std::string> read_sealed(const Cache& cache, const std::string& key,
                                       const fs::path& path) {
  if (!cache.usable() || !directory_problem(cache.directory).empty()) return {};
  struct stat info {};
  if (::lstat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode) || info.st_uid != ::geteuid() ||
      (info.st_mode & 022) != 0) {
    return {};
  }
  try {
    std::string content = read_file(path);
    if (!is_intact(key, content)) return {};
    ::utimensat(AT_FDCWD, path.c_str(), nullptr, AT_SYMLINK_NOFOLLOW);
    return content;
  } catch (const ToolError&) {
    return {};
  }
}

const char* environment(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr && value[0] != '\0' ? value : nullptr;
}

std::string refused(const fs::path& directory, std::string_view reason) {
  return fmt::format("the cache '{}' is not used: {}", directory.string(), reason);
}

// What -march=native stands for on this machine.
std::string processor() {
  std::string text;
  try {
    text = read_file("/proc/cpuinfo");
  } catch (const ToolError&) {
    return "unknown";
  }
  std::string chosen;
  for (const std::string_view name : {"model name", "flags", "CPU part", "Features"}) {
    const std::size_t at = text.find(fmt::format("\n{}", name));
    if (at != std::string::npos) chosen += text.substr(at, text.find('\n', at + 1) - at);
  }
  return chosen;
}

std::vector<fs::directory_entry> entries_of(const Cache& cache) {
  std::vector<fs::directory_entry> entries;
  if (!cache.usable() || !directory_problem(cache.directory).empty()) return entries;
  std::error_code failed;
  fs::directory_iterator at(cache.directory, failed);
  for (; !failed && at != fs::directory_iterator(); at.increment(failed)) entries.push_back(*at);
  return entries;
}

}  // namespace

fs::path default_cache_directory() {
  if (const char* const chosen = environment("HAMGEN_CACHE")) return chosen;
  // The XDG specification asks to ignore a relative path.
  if (const char* const base = environment("XDG_CACHE_HOME"); base != nullptr && base[0] == '/') {
    return fs::path(base) / "hamgen";
  }
  if (const char* const home = environment("HOME")) return fs::path(home) / ".cache" / "hamgen";
  return {};
}

std::string directory_problem(const fs::path& directory) {
  struct stat info {};
  if (::lstat(directory.c_str(), &info) != 0) {
    return refused(directory, std::generic_category().message(errno));
  }
  if (S_ISLNK(info.st_mode)) return refused(directory, "it is a symbolic link");
  if (!S_ISDIR(info.st_mode)) return refused(directory, "it is not a directory");
  if (info.st_uid != ::geteuid()) return refused(directory, "it belongs to another user");
  if ((info.st_mode & 022) != 0) {
    return refused(directory, "other users may write to it (chmod go-w would repair that)");
  }
  if (::access(directory.c_str(), R_OK | W_OK | X_OK) != 0) {
    return refused(directory, std::generic_category().message(errno));
  }
  return {};
}

Cache open_cache(const fs::path& directory) {
  if (directory.empty()) {
    return {.directory = {}, .problem = "no cache: neither HAMGEN_CACHE nor HOME is set"};
  }
  std::error_code failed;
  fs::path path = fs::absolute(directory, failed).lexically_normal();
  if (failed) return {.directory = directory, .problem = refused(directory, failed.message())};
  // With a slash at the end lstat would look behind a link.
  if (!path.has_filename() && path.has_relative_path()) path = path.parent_path();
  fs::create_directories(path.parent_path(), failed);
  if (!failed && ::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) {
    failed = std::error_code(errno, std::generic_category());
  }
  if (failed) return {.directory = path, .problem = refused(path, failed.message())};
  return {.directory = path, .problem = directory_problem(path)};
}

std::string cache_key(const PluginSource& source, const Compiler& compiler,
                      const CompileOptions& options) {
  Sha256 hash;
  hash.update_field(fmt::format("plugin interface {}", HAMGEN_PLUGIN_VERSION));
  hash.update_field(plugin_header_text());
  hash.update_field(source.name);
  hash.update_field(source.text);
  for (const SourceFile& header : source.headers) {
    hash.update_field(header.name);
    hash.update_field(header.text);
  }
  hash.update_field(compiler.identity);
  bool native = false;
  for (const std::vector<std::string>& words :
       {compiler.command, compile_flags(source, compiler, options)}) {
    for (const std::string& word : words) {
      hash.update_field(word);
      native = native || word.ends_with("=native");
    }
  }
  if (native) hash.update_field(processor());
  return hash.hex();
}

std::optional<fs::path> find_object(const Cache& cache, const std::string& key) {
  const fs::path path = object_path(cache, key);
  return read_sealed(cache, key, path) ? std::optional(path) : std::nullopt;
}

fs::path publish_object(const Cache& cache, const std::string& key, const fs::path& object) {
  if (std::string problem = directory_problem(cache.directory); !problem.empty()) {
    throw ToolError({.message = problem});
  }
  const std::string content = read_file(object);
  AtomicFile file(object);
  file.write(content);
  file.write(seal(key, content));
  file.publish();
  fs::path place = object_path(cache, key);
  if (::chmod(object.c_str(), 0600) != 0 || ::rename(object.c_str(), place.c_str()) != 0) {
    throw file_error("write", place, errno);
  }
  return place;
}

std::optional<std::string> find_text(const Cache& cache, const std::string& key) {
  std::optional<std::string> content = read_sealed(cache, key, text_path(cache, key));
  if (content) content->resize(content->size() - kSealSize);
  return content;
}

void publish_text(const Cache& cache, const std::string& key, std::string_view text) {
  if (std::string problem = directory_problem(cache.directory); !problem.empty()) {
    throw ToolError({.message = problem});
  }
  const fs::path place = text_path(cache, key);
  AtomicFile file(place);
  file.write(text);
  file.write(seal(key, text));
  file.publish();
  if (::chmod(place.c_str(), 0600) != 0) throw file_error("write", place, errno);
}

void publish_record(const Cache& cache, const std::string& key, const CacheRecord& record) {
  if (std::string problem = directory_problem(cache.directory); !problem.empty()) {
    throw ToolError({.message = problem});
  }
  const fs::path place = record_path(cache, key);
  std::error_code missing;
  if (fs::is_regular_file(fs::symlink_status(place, missing))) return;
  fs::remove(place, missing);  // a link would be followed
  const std::string text = fmt::format("{}\n{}\n{:%Y-%m-%d}\n", one_line(record.model),
                                       one_line(record.scheme), fmt::gmtime(std::time(nullptr)));
  AtomicFile file(place);
  file.write(text);
  file.write(seal(key, text));
  file.publish();
  if (::chmod(place.c_str(), 0600) != 0) throw file_error("write", place, errno);
}

std::optional<CacheRecord> find_record(const Cache& cache, const std::string& key) {
  const fs::path place = record_path(cache, key);
  std::error_code missing;
  const std::uintmax_t size = fs::file_size(place, missing);
  if (missing || size > kLargestRecord) return {};
  const std::optional<std::string> text = read_sealed(cache, key, place);
  if (!text) return {};
  std::vector<std::string> fields;
  for (std::size_t begin = 0, end = 0; fields.size() < 3; begin = end + 1) {
    end = text->find('\n', begin);
    if (end == std::string::npos) return {};
    fields.push_back(text->substr(begin, end - begin));
  }
  return CacheRecord{.model = fields[0], .scheme = fields[1], .made = fields[2]};
}

std::vector<CacheEntry> list_cache(const Cache& cache) {
  std::vector<CacheEntry> list;
  for (const fs::directory_entry& entry : entries_of(cache)) {
    const fs::path name = entry.path().filename();
    std::error_code failed;
    const std::string extension = name.extension().string();
    if ((extension != ".so" && extension != ".txt") || !is_key(name.stem().string())) continue;
    const CacheEntry found{.key = name.stem().string(),
                           .extension = extension,
                           .bytes = entry.file_size(failed),
                           .last_used = entry.last_write_time(failed)};
    if (!failed) list.push_back(found);
  }
  std::ranges::sort(list, [](const CacheEntry& a, const CacheEntry& b) {
    return a.last_used != b.last_used ? a.last_used > b.last_used : a.key < b.key;
  });
  return list;
}

CacheRemoval clear_cache(const Cache& cache) {
  for (const fs::directory_entry& entry : entries_of(cache)) {
    std::error_code ignored;
    if (is_left_over(entry)) fs::remove_all(entry.path(), ignored);
    if (is_record(entry)) fs::remove(entry.path(), ignored);
  }
  return prune_cache(cache, 0);
}

CacheRemoval prune_cache(const Cache& cache, std::uintmax_t limit) {
  for (const fs::directory_entry& entry : entries_of(cache)) {
    std::error_code failed;
    const fs::file_time_type yesterday = fs::file_time_type::clock::now() - std::chrono::days(1);
    if (is_left_over(entry) && entry.last_write_time(failed) < yesterday && !failed) {
      fs::remove_all(entry.path(), failed);
    }
  }
  CacheRemoval removal;
  std::uintmax_t kept = 0;
  for (const CacheEntry& entry : list_cache(cache)) {
    kept += entry.bytes;
    std::error_code failed;
    if (kept <= limit || !fs::remove(cache.directory / (entry.key + entry.extension), failed))
      continue;
    fs::remove(record_path(cache, entry.key), failed);
    ++removal.entries;
    removal.bytes += entry.bytes;
  }
  return removal;
}

}  // namespace hamgen::runtime
