// What a compiled step does, measured beside what algebra proves of it.
#pragma once

#include "generator/pipeline.hpp"

namespace hamgen::app {

// The tangent map of the compiled step around the scene (empty: the default one), and along the
// scene the change of every invariant.
[[nodiscard]] Proof measure(const SourceText& source, Request request, const std::string& scene,
                            bool symmetric);

}  // namespace hamgen::app
