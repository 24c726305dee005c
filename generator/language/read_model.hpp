// Source text to Model: lexing, parsing, and every check that needs no algebra.
#pragma once

#include "generator/language/model.hpp"

namespace hamgen {

// Throws one ModelError with all mistakes of the file.
[[nodiscard]] Model read_model(const SourceText& source);

// The same model with other integer constants: "N = 1000" (command line --set N=1000 on a size).
// Throws UsageError on an unknown size.
[[nodiscard]] Model read_model(const SourceText& source, const std::map<std::string, long>& sizes);

// A free-standing expression such as an --alpha argument, over the given names (scalars, or
// elements as "m[2]").  Throws ModelError against a SourceText named `what` ("--beta").
[[nodiscard]] NodePtr read_expression(const std::string& what, const std::string& text,
                                      const std::vector<std::string>& names);
// The two halves of it: whatever its names are, and that these are the names.
[[nodiscard]] NodePtr read_grammar(const std::string& what, const std::string& text);
void require_names(const NodePtr& node, const std::string& what, const std::string& text,
                   const std::vector<std::string>& names);

}  // namespace hamgen
