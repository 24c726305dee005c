// What --json prints.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace hamgen::app {

// The value as text, two blanks a level, with a line end.  What is not ASCII is escaped: nothing in
// a path or a comment can turn the order in which a terminal shows the text.  Bytes that are not
// UTF-8 become U+FFFD, for which JSON leaves no other way.
[[nodiscard]] std::string json_document(const nlohmann::ordered_json& value);

}  // namespace hamgen::app
