// Scenes and their settings.
#pragma once

#include <vector>

#include "generator/language/expression_parser.hpp"
#include "generator/language/syntax.hpp"

namespace hamgen {

// From the '{' to the '}'.  A mistake in a setting is collected and the next setting read.
[[nodiscard]] SceneStatement parse_scene(ExpressionParser& in, const Name& name,
                                         std::vector<Diagnostic>& diagnostics);

// q = 3.1, q[i] = sin(pi*i/(N+1)), q = [1, 0, 0].
[[nodiscard]] Setting setting(ExpressionParser& in);

// energy, L, q[2], radius = sqrt(x^2 + y^2), from its first name on.
[[nodiscard]] std::vector<Observed> observed_list(ExpressionParser& in);

// [1, 2, 3]
[[nodiscard]] std::vector<NodePtr> value_list(ExpressionParser& in);

}  // namespace hamgen
