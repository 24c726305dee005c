// Where H is defined, as far as its form shows.
#pragma once

#include "generator/language/model.hpp"

namespace hamgen::app {

// H is a sum of products of powers 0, 1, 2, ... and of functions that are defined and smooth for
// every real number: a value of H or of its gradient that is not finite is an overflow then, inf -
// inf included.  False where the form alone does not show it, as for sqrt(1 + q^2).
[[nodiscard]] bool is_defined_everywhere(const Model& model);

}  // namespace hamgen::app
