// An expression in balls.
#pragma once

#include <map>
#include <string>

#include "app/studies/ball.hpp"
#include "generator/algebra/expression.hpp"

namespace hamgen::app {

// Not finite where it is not defined, or uses a symbol without a value.
[[nodiscard]] Ball evaluate_in_balls(const Expression& e, const std::map<std::string, Ball>& values,
                                     long bits);

}  // namespace hamgen::app
