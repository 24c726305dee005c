#include "app/output/output_name.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "generator/base/diagnostic.hpp"

namespace hamgen::app {

OutputKind output_kind(const std::string& name) {
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

OutputKind table_kind(const std::string& name) {
  const OutputKind kind = output_kind(name);
  if (kind != OutputKind::directory) return kind;
  throw UsageError(fmt::format(
      "-o {}: one table is written, and its name ends in .csv or .json\nhelp: -o {}.csv", name,
      (std::filesystem::path(name) / "").parent_path().replace_extension().string()));
}

void require_one_document(bool json, OutputKind kind) {
  if (json && kind == OutputKind::standard)
    throw UsageError(
        "--json and -o - both write to standard output\nhelp: give the table a file: -o FILE.csv");
}

}  // namespace hamgen::app
