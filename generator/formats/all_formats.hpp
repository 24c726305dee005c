// THE LIST of output formats.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "generator/formats/emit_options.hpp"
#include "generator/formats/output_files.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

struct NamedFormat {
  std::string_view name;         // "cpp-header", "cpp-plugin", "cmake-package"
  std::string_view description;  // one line
  OutputFiles (*files)(const Program& program, const EmitOptions& options);
  bool takes_loops = true;  // over degrees of freedom
};

// The first is the default.
[[nodiscard]] std::span<const NamedFormat> all_formats();
// "" is the default; "c" and "cpp" are the headers.  Throws UsageError for a name that is not in
// the list.
[[nodiscard]] const NamedFormat& find_format(std::string_view name);

// One of the list.
struct FormatWish {
  const NamedFormat* format = nullptr;
  [[nodiscard]] static FormatWish read(const std::string& name) { return {&find_format(name)}; }
};

}  // namespace hamgen
