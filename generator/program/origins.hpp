// Why the instructions of a step are there: how often they are done, and which terms of H they come
// from.
#pragma once

#include "generator/program/environment.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// Note [origins]
// A coefficient belongs to the run if it depends on parameters alone, to the step size if on h.
// What an iteration does over and over is the iteration's, the rest of solve the step's.
//
// The derivatives of H come from the terms that contain their variables; what is computed of them
// comes from the same, up to the next stage value or increment, which all of H has moved.  What a
// derivative is computed of comes from the terms of all derivatives that use it.  A derivative as
// cheap as a name, p of p^2/2, is written where it is used and names none there.  Loops have the
// terms of their kernels.  At a higher order, where K stands in for H, every term is in everything,
// and none is named.
void trace_origins(Program& code, const Environment& environment, const StepEquations& equations);

}  // namespace hamgen
