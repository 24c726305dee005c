// What hamgen promises of any bytes at all, as a model or as an option.
#pragma once

#include <string_view>

namespace hamgen::fuzz {

enum class Answer { accepted, refused };

// An input that begins with an option, "--beta 0.01*h" or "--set m=2", is that option on a model of
// its own; any other is a model.  It is either refused, by a ModelError or UsageError that says
// something, or accepted: and then its text reads back as itself.  Whatever else happens is thrown.
[[nodiscard]] Answer check_input(std::string_view input);

}  // namespace hamgen::fuzz
