// Words to statements.
#pragma once

#include <string>

#include "generator/language/event_parser.hpp"
#include "generator/language/syntax.hpp"

namespace hamgen {

// All statements that could be read, and a diagnostic for each that could not.
[[nodiscard]] Syntax parse(const SourceText& source);

// One line of a scene, "q[1] = 0.1", from a text of its own.  Throws ModelError.
[[nodiscard]] Setting parse_setting(const SourceText& source);
// What a scene observes, "energy, q[2], r = sqrt(x^2)", likewise.
[[nodiscard]] std::vector<Observed> parse_observed(const SourceText& source);
// What ends a run, likewise.
[[nodiscard]] EndSyntax parse_end_of_run(const SourceText& source);

// One expression that fills its text.  Throws ModelError.
[[nodiscard]] NodePtr parse_expression(const SourceText& source);

// A part of the source on one line, without comments.
[[nodiscard]] std::string one_line(const SourceText& source, Span span);

}  // namespace hamgen
