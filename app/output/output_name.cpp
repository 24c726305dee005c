#include "app/output/output_name.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>

#include "app/output/terminal.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

OutputKind kind_by_ending(const std::string& name) {
  if (name.empty()) return OutputKind::none;
  if (name == "-") return OutputKind::standard;
  const std::string ending = std::filesystem::path(name).extension().string();
  if (std::filesystem::is_directory(name)) return OutputKind::directory;
  if (ending == ".csv") return OutputKind::csv;
  if (ending == ".json") return OutputKind::json;
  if (ending == ".svg" || ending == ".png")
    throw UsageError(
        fmt::format("-o {}: the numbers go there\nhelp: for a picture: --plot {}", name, name));
  return OutputKind::directory;
}

void make_directory_above(const std::string& name, bool quiet) {
  namespace fs = std::filesystem;
  if (name.empty() || name == "-") return;
  const fs::path path = name;
  const fs::path parent = (path.has_filename() ? path : path.parent_path()).parent_path();
  fs::path missing;
  for (fs::path above = parent; !above.empty() && !fs::exists(above); above = above.parent_path())
    missing = above;
  if (missing.empty()) return;
  std::error_code failed;
  fs::create_directories(parent, failed);
  if (failed) throw runtime::file_error("create the directory", parent, failed.value());
  if (!quiet) print_error(fmt::format("{}/ (a new directory)\n", missing.string()));
}

}  // namespace

OutputKind output_kind(const std::string& name) {
  const OutputKind kind = kind_by_ending(name);
  if (kind == OutputKind::directory) require_directory("-o", name);
  return kind;
}

OutputKind table_kind(const std::string& name) {
  const OutputKind kind = kind_by_ending(name);
  if (kind != OutputKind::directory) return kind;
  throw UsageError(fmt::format(
      "-o {}: one table is written, and its name ends in .csv or .json\nhelp: -o {}.csv", name,
      (std::filesystem::path(name) / "").parent_path().replace_extension().string()));
}

void require_directory(const std::string& option, const std::string& name) {
  if (name == "-")
    throw UsageError(
        fmt::format("{0} -: files are written into a directory, and standard output is none\n"
                    "help: {0} DIRECTORY/",
                    option));
  const std::string ending = std::filesystem::path(name).extension().string();
  const bool is_word = ending.size() > 1 && ending.size() <= 5 &&
                       std::isalpha(static_cast<unsigned char>(ending[1])) != 0;
  if (!is_word || std::filesystem::is_directory(name)) return;
  throw UsageError(
      fmt::format("{0} {1}: files are written into a directory, and this is the name of a file\n"
                  "help: for a directory of that name: {0} {1}/",
                  option, name));
}

void make_directories_above(std::initializer_list<std::string> names, bool quiet) {
  for (const std::string& name : names) make_directory_above(name, quiet);
}

void require_writable(std::initializer_list<std::string> names) {
  for (const std::string& name : names) {
    const std::filesystem::path path = name;
    if (path.has_extension() && !std::filesystem::is_directory(path))
      runtime::require_writable(path);
  }
}

void require_apart(const std::string& option, const std::string& name, const std::string& other,
                   const std::string& what) {
  if (name.empty() || other.empty() || name == "-" || other == "-") return;
  namespace fs = std::filesystem;
  std::error_code failed;
  const bool is_same =
      fs::equivalent(name, other, failed) || fs::weakly_canonical(fs::absolute(name), failed) ==
                                                 fs::weakly_canonical(fs::absolute(other), failed);
  if (is_same)
    throw UsageError(
        fmt::format("{} {}: that is {}\nhelp: give it a file of its own", option, name, what));
}

void require_file(const std::string& option, const std::string& name) {
  if (name.empty() || name == "-") return;
  const std::filesystem::path path = name;
  if (path.has_filename() && !std::filesystem::is_directory(path))
    return runtime::require_writable(path);
  throw UsageError(
      fmt::format("{0} {1}: this is a directory, and one file is written\nhelp: {0} {2}", option,
                  name, ((path / "").parent_path() / "NAME.csv").string()));
}

void require_one_document(bool json, OutputKind kind) {
  if (json && kind == OutputKind::standard)
    throw UsageError(
        "--json and -o - both write to standard output\nhelp: give the table a file: -o FILE.csv");
}

}  // namespace hamgen::app
