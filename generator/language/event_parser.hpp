// What is looked for along an orbit, as it is written.
#pragma once

#include <string>

#include "generator/language/expression_parser.hpp"
#include "generator/language/model.hpp"

namespace hamgen {

// EXPR, EXPR rising or EXPR falling: where it crosses zero.  Without a name.
[[nodiscard]] ModelEvent crossing(ExpressionParser& in, const SourceText& source);

// What --until names: a crossing, or A > B, A < B.
struct EndSyntax {
  ModelEvent crossing;  // of a comparison the left side, both directions
  NodePtr right = {};   // null for a crossing
  bool less = false;
};
[[nodiscard]] EndSyntax end_of_run(ExpressionParser& in, const SourceText& source);

}  // namespace hamgen
