// THE LIST of output formats.
#pragma once

#include <span>
#include <string_view>

namespace hamgen {

struct NamedFormat {
  std::string_view name;         // "cpp-header", "cpp-plugin", "cmake-package"
  std::string_view description;  // one line
};

[[nodiscard]] std::span<const NamedFormat> all_formats();

}  // namespace hamgen
