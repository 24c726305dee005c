// hamgen cache: the compiled integrators that are kept for the next run.
#include "runtime/cache.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/command_line.hpp"
#include "app/output/json_document.hpp"
#include "app/output/terminal.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"
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

// Of as many columns; what is longer is cut.
std::string short_text(const std::string& text, std::size_t width) {
  std::string shown = visible_text(text);
  if (shown.size() > width) shown = shown.substr(0, width - 3) + "...";
  return shown;
}

bool is_reference(const runtime::CacheEntry& entry) { return entry.extension == ".txt"; }

int list_as_json(const runtime::Cache& cache) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const runtime::CacheEntry& entry : runtime::list_cache(cache)) {
    const auto record = runtime::find_record(cache, entry.key);
    nlohmann::ordered_json row = {{"key", entry.key},
                                  {"kind", is_reference(entry) ? "reference" : "integrator"},
                                  {"model", nullptr},
                                  {"scheme", nullptr},
                                  {"made", nullptr}};
    if (record) row.update({{"model", record->model}, {"scheme", record->scheme}});
    if (record) row["made"] = record->made;
    row["bytes"] = entry.bytes;
    rows.push_back(std::move(row));
  }
  print(json_document(nlohmann::ordered_json{{"directory", cache.directory.string()},
                                             {"limit", runtime::kCacheLimit},
                                             {"entries", std::move(rows)}}));
  return done;
}

int list_entries(const runtime::Cache& cache) {
  const std::vector<runtime::CacheEntry> entries = runtime::list_cache(cache);
  std::uintmax_t total = 0;
  std::string text;
  for (const runtime::CacheEntry& entry : entries) {
    total += entry.bytes;
    const auto record = runtime::find_record(cache, entry.key);
    const std::string what = !record ? "no record of what it is"
                                     : fmt::format("{}, {}{}", record->model, record->scheme,
                                                   is_reference(entry) ? ", reference" : "");
    text += fmt::format("{:.12}  {:<46}  {:<10}  {:>8}  used {}\n", entry.key, short_text(what, 46),
                        short_text(record ? record->made : "", 10), size_text(entry.bytes),
                        age_text(entry.last_used));
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

int cache_command(const std::string& action, bool json) {
  if (action != "list" && action != "clear" && action != "prune")
    throw UsageError(fmt::format(
        "cache {}: no such action\nhelp: the actions are list, clear and prune", action));
  if (json && action != "list")
    throw UsageError(fmt::format("cache {} --json: it is the list that --json prints", action));
  const runtime::Cache cache = runtime::open_cache();
  if (!cache.usable())
    throw runtime::ToolError(
        {.message = cache.problem, .command = {}, .exit_status = {}, .output_tail = {}});
  if (action == "list") return json ? list_as_json(cache) : list_entries(cache);
  const runtime::CacheRemoval removed =
      action == "clear" ? runtime::clear_cache(cache) : runtime::prune_cache(cache);
  print(fmt::format("removed {} file{}, {}\n", removed.entries, removed.entries == 1 ? "" : "s",
                    size_text(removed.bytes)));
  return done;
}

}  // namespace

Command add_cache(CLI::App& app) {
  const auto action = std::make_shared<std::string>("list");
  const auto json = std::make_shared<bool>(false);
  CLI::App* parser = app.add_subcommand("cache", "lists or removes compiled integrators");
  parser->add_option("ACTION", *action,
                     "list (default), clear: remove all, or prune: keep the most recently used");
  parser->add_flag("--json", *json, "the list as JSON");
  parser->footer(
      "The cache is in $HAMGEN_CACHE, else $XDG_CACHE_HOME/hamgen, else ~/.cache/hamgen.");
  return {parser, [action, json] { return cache_command(*action, *json); }};
}

}  // namespace hamgen::app
