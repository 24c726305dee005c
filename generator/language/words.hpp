// Words with a meaning of their own, which no declaration may take.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hamgen {

inline constexpr std::size_t longest_name = 64;

// A word that begins a statement: "system", "coordinate", ... and "H".
[[nodiscard]] bool begins_statement(std::string_view word);
[[nodiscard]] const std::vector<std::string>& statement_words();

// What a reserved word means ("the step size"), empty for a word that is free.
[[nodiscard]] std::string reserved_meaning(std::string_view word);

}  // namespace hamgen
