// What a compiled step does, measured beside what algebra proves of it.
#pragma once

#include "generator/pipeline.hpp"

namespace hamgen::app {

// At 100 random states and parameters around the scene (empty: the default one): the defect
// M^T J M - J of the compiled step's tangent map M, the reversal residual of a symmetric step, and
// along the scene the change of every invariant.
[[nodiscard]] Proof measure(const SourceText& source, Request request, const std::string& scene,
                            bool symmetric);

}  // namespace hamgen::app
