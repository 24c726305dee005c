// Whether the sums of H are written out or stay loops.
#pragma once

#include <string>

#include "generator/language/model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/mechanics/mechanics.hpp"
#include "generator/request.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

// Is a part of H a sum over an index?
[[nodiscard]] bool has_sums(const Model& model);

// Is there something in the request that is made of expressions?  Loops have none.
[[nodiscard]] bool asks_for_expressions(const Request& request, const Scheme& scheme);

// Of a system in both forms: does a step of the implicit midpoint rule take less time in loops? The
// rule stands for all methods, for these share the functions of a system's header.  Of what a scene
// does not need loops leave out whole arrays only: where more is left out it is written out.
[[nodiscard]] bool are_loops_quicker(const Mechanics& written_out, const Mechanics& in_loops);

// What in the request needs the derivatives of functions of sums, and has these written out: "the
// tangent map", or "".
[[nodiscard]] std::string wish_for_all_second_derivatives(const Request& request);

// The system, in loops where that is wanted.  A function of sums is written out where more is asked
// for than its gradient, and one variable that all others have to do with where a higher order is.
[[nodiscard]] Mechanics derive_for(const Request& request, const Model& model, bool keep_sums,
                                   int most = kMostWrittenOut);

}  // namespace hamgen
