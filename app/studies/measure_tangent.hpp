// The tangent map M = dZ/dz of a compiled step, measured.
#pragma once

#include "generator/verify/proof.hpp"
#include "runtime/integrator.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::app {

// At 100 states and parameters around the orbit of the scene: M^T J M - J, M against difference
// quotients of the step, and of a symmetric step how far a step back misses its start.
[[nodiscard]] Proof measure_tangent(const runtime::LoadedPlugin& loaded,
                                    const runtime::InitialValues& start, bool symmetric);

}  // namespace hamgen::app
