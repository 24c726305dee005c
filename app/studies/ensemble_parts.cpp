#include "app/studies/ensemble_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "generator/base/diagnostic.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/temporary_name.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kManifest = "manifest";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

std::vector<std::string> all_lines(const EnsembleManifest& manifest) {
  std::vector<std::string> lines = manifest.lines;
  lines.push_back(fmt::format("count     {}, {} a record", manifest.count, manifest.block));
  lines.push_back(fmt::format("columns   {}", fmt::join(manifest.columns, ",")));
  return lines;
}

bool is_part(const fs::path& path) { return path.filename().string().starts_with("part-"); }

std::vector<fs::path> entries_of(const fs::path& directory) {
  std::vector<fs::path> entries;
  std::error_code failed;
  for (fs::directory_iterator at(directory, failed), end; !failed && at != end;
       at.increment(failed))
    entries.push_back(at->path());
  if (failed) throw runtime::file_error("read", directory, failed.value());
  std::ranges::sort(entries);
  return entries;
}

}  // namespace

fs::path parts_directory(const fs::path& output) {
  fs::path directory = output;
  directory += ".parts";
  return directory;
}

fs::path part_path(const fs::path& output, int rank) {
  return parts_directory(output) / fmt::format("part-{:06}", rank);
}

std::string difference_of(const std::vector<std::string>& there,
                          const std::vector<std::string>& here) {
  std::string text;
  const auto add = [&text](const char* where, const std::vector<std::string>& lines,
                           const std::vector<std::string>& others) {
    for (const std::string& line : lines) {
      if (std::ranges::find(others, line) == others.end())
        text += fmt::format("  {:<6} {}\n", where, line);
    }
  };
  add("there", there, here);
  add("here", here, there);
  return text;
}

EnsembleParts::EnsembleParts(const fs::path& output, const EnsembleManifest& manifest, bool resume)
    : directory_(parts_directory(output)), manifest_(manifest) {
  std::error_code failed;
  fs::create_directories(directory_, failed);
  if (failed) throw runtime::file_error("create the directory", directory_, failed.value());
  lock_ = runtime::DirectoryLock(directory_);
  check(manifest, resume);
}

void EnsembleParts::check(const EnsembleManifest& manifest, bool resume) {
  const std::vector<std::string> lines = all_lines(manifest);
  const fs::path path = directory_ / kManifest;
  if (!fs::exists(path)) {
    // A killed process may leave the manifest's temporary file.
    for (const fs::path& entry : entries_of(directory_)) {
      if (entry.filename().string().starts_with("." + std::string(kManifest))) continue;
      throw UsageError(
          fmt::format("'{}' is there, and no directory of an ensemble: it has no manifest\nhelp: "
                      "another name of the output, or remove the directory",
                      directory_.string()));
    }
    runtime::atomic_write(path, fmt::format("{}\n", fmt::join(lines, "\n")));
    return;
  }
  if (!resume)
    throw UsageError(fmt::format(
        "'{0}' has what is done of an ensemble that did not come to its end\nhelp: --resume goes "
        "on with it; to begin anew, remove that directory",
        directory_.string()));
  const std::string difference = difference_of(lines_of(runtime::read_file(path)), lines);
  if (!difference.empty())
    throw UsageError(
        fmt::format("--resume: '{}' is of another ensemble:\n{}help: resume with the command it "
                    "was begun with; to begin anew, remove that directory",
                    directory_.string(), difference));
}

void EnsembleParts::scan() {
  files_.clear();
  spoilt_ = 0;
  found_.assign(static_cast<std::size_t>(manifest_.blocks()), {});
  const std::size_t row = 16 + 8 * manifest_.columns.size();
  for (const fs::path& path : entries_of(directory_)) {
    if (!is_part(path)) continue;
    const runtime::PartScan part = runtime::scan_part_file(path);
    spoilt_ += static_cast<long long>(part.spoilt);
    for (const runtime::PartRecord& record : part.records) {
      if (record.key >= found_.size() ||
          record.size !=
              row * static_cast<std::size_t>(manifest_.rows_of(static_cast<long long>(record.key))))
        throw runtime::ToolError(
            {.message = fmt::format("'{}' has records of another ensemble", path.string())});
      found_[record.key] = {.file = static_cast<int>(files_.size()), .record = record};
    }
    files_.push_back(path);
  }
}

std::vector<long long> EnsembleParts::missing() const {
  std::vector<long long> blocks;
  for (std::size_t i = 0; i < found_.size(); ++i) {
    if (found_[i].file < 0) blocks.push_back(static_cast<long long>(i));
  }
  return blocks;
}

void EnsembleParts::read(const std::function<void(const std::vector<EnsembleRow>&)>& take) const {
  constexpr std::size_t most_open = 200;  // of thousands of ranks
  std::map<int, runtime::PartReader> open;
  std::vector<std::byte> bytes;
  for (const Found& each : found_) {
    if (each.file < 0) internal_error("a block is missing");
    if (!open.contains(each.file)) {
      if (open.size() >= most_open) open.clear();
      open.emplace(each.file, runtime::PartReader(files_[static_cast<std::size_t>(each.file)]));
    }
    open.at(each.file).read(each.record, bytes);
    take(unpacked(bytes, manifest_.columns.size()));
  }
}

void EnsembleParts::remove() {
  // Renamed first: what a kill leaves then is no unfinished ensemble.
  std::error_code failed;
  const fs::path aside = runtime::temporary_name(directory_);
  fs::rename(directory_, aside, failed);
  if (!failed) fs::remove_all(aside, failed);
  if (failed) throw runtime::file_error("remove", directory_, failed.value());
}

}  // namespace hamgen::app
