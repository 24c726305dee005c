// Who may include what, as a table.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace architecture {

struct Include {
  std::string name;  // as between the quotes or brackets
  bool angled = false;
  bool operator==(const Include&) const = default;
};

enum class External { standard, system, fmt, gmp, ginac, eigen, quadmath, arb, other };

// What a name in angle brackets belongs to.
[[nodiscard]] External classify(std::string_view name);
// Is the file in a folder that may not see GiNaC even through a header it includes?
[[nodiscard]] bool free_of_ginac(std::string_view file);
// What is wrong with the include, or nothing.  Paths are relative to the root of the tree.
[[nodiscard]] std::optional<std::string> violation(std::string_view file, const Include& include);

}  // namespace architecture
