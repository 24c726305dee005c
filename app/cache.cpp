// hamgen cache: the compiled integrators that are kept for the next run.
#include "runtime/cache.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/command_line.hpp"
#include "app/output/terminal.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

std::string size_text(std::uintmax_t bytes) {
  const double kilobytes = static_cast<double>(bytes) / 1024.0;
  return kilobytes < 1024.0 ? fmt::format("{:.1f} kB", kilobytes)
                            : fmt::format("{:.1f} MB", kilobytes / 1024.0);
}

std::string age_text(std::filesystem::file_time_type time) {
  using namespace std::chrono;
  const auto age = duration_cast<minutes>(std::filesystem::file_time_type::clock::now() - time);
  if (age < minutes(1)) return "just now";
  if (age < hours(1)) return fmt::format("{} min ago", age.count());
  if (age < hours(48)) return fmt::format("{} h ago", age.count() / 60);
  return fmt::format("{} days ago", age.count() / (24 * 60));
}

int list_entries(const runtime::Cache& cache) {
  const std::vector<runtime::CacheEntry> entries = runtime::list_cache(cache);
  std::uintmax_t total = 0;
  std::string text;
  for (const runtime::CacheEntry& entry : entries) {
    total += entry.bytes;
    text += fmt::format("{:.16}{}  {:>10}  used {}\n", entry.key,
                        entry.extension == ".txt" ? " reference " : "           ",
                        size_text(entry.bytes), age_text(entry.last_used));
  }
  const auto references = static_cast<std::size_t>(
      std::ranges::count(entries, ".txt", &runtime::CacheEntry::extension));
  const std::size_t compiled = entries.size() - references;
  print(fmt::format("{}{}: {} compiled integrator{}{}, {} of at most {}\n", text,
                    cache.directory.string(), compiled, compiled == 1 ? "" : "s",
                    references == 0 ? "" : fmt::format(", {} reference solutions", references),
                    size_text(total), size_text(runtime::kCacheLimit)));
  return done;
}

int cache_command(const std::string& action) {
  if (action != "list" && action != "clear" && action != "prune")
    throw UsageError(fmt::format(
        "cache {}: no such action\nhelp: the actions are list, clear and prune", action));
  const runtime::Cache cache = runtime::open_cache();
  if (!cache.usable())
    throw runtime::ToolError(
        {.message = cache.problem, .command = {}, .exit_status = {}, .output_tail = {}});
  if (action == "list") return list_entries(cache);
  const runtime::CacheRemoval removed =
      action == "clear" ? runtime::clear_cache(cache) : runtime::prune_cache(cache);
  print(fmt::format("removed {} file{}, {}\n", removed.entries, removed.entries == 1 ? "" : "s",
                    size_text(removed.bytes)));
  return done;
}

}  // namespace

Command add_cache(CLI::App& app) {
  const auto action = std::make_shared<std::string>("list");
  CLI::App* parser = app.add_subcommand("cache", "lists or removes compiled integrators");
  parser->add_option("ACTION", *action,
                     "list (default), clear: remove all, or prune: keep the most recently used");
  parser->footer(
      "The cache is in $HAMGEN_CACHE, else $XDG_CACHE_HOME/hamgen, else ~/.cache/hamgen.");
  return {parser, [action] { return cache_command(*action); }};
}

}  // namespace hamgen::app
