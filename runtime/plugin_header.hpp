// The text of plugin.h, so that an installed program can compile plugins without finding its own
// sources.  plugin_header.cpp is made from plugin_header.cpp.in and plugin.h by the build.
#pragma once

#include <string_view>

namespace hamgen::runtime {

[[nodiscard]] std::string_view plugin_header_text();

}  // namespace hamgen::runtime
