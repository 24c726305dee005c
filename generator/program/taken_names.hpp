// Names that the headers of C, C++ and POSIX have taken before a user's model came.
#pragma once

#include <string_view>

namespace hamgen {

// A macro without arguments of these headers, or of plugin.h: it is replaced wherever it stands.
[[nodiscard]] bool is_macro(std::string_view name);

// Something in the global namespace of these headers, or of an emitted plugin: no namespace can
// have its name.
[[nodiscard]] bool is_global(std::string_view name);

}  // namespace hamgen
