// The headers of generator/numerics as texts: what emitted files have a copy of.
#pragma once

#include <span>
#include <string_view>

namespace hamgen {

// A header's name, "two_sum", and its text.  Their table is made from the headers by the build: an
// installed hamgen has no sources.
struct NumericsText {
  std::string_view name;
  std::string_view text;
};
[[nodiscard]] std::span<const NumericsText> all_numerics();

// plugin.h, the C interface of a plugin, which every plugin has a copy of.
[[nodiscard]] std::string_view plugin_header();

}  // namespace hamgen
