// The emitted class Elimination, which solves for the stages of a Runge-Kutta method.
#pragma once

namespace hamgen {

// Needs `stages`, `dimension`, `Real` and `magnitude` before it.
[[nodiscard]] const char* elimination_text();

}  // namespace hamgen
