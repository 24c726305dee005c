// The namespaces of what a request emits.
#pragma once

#include "generator/equations/step_equations.hpp"
#include "generator/formats/emit_options.hpp"
#include "generator/pipeline.hpp"

namespace hamgen {

// By default the system's is its name, below it what the request changes of the system ("quad",
// "N_64", "folded_eps") and the scene that something was left out for, so that equal names mean
// equal records; the method's is the name of the scheme with what the request changes of that
// ("member_alpha_3_10", "gauss_4_fixed_point").
//
// --namespace a::b::c replaces both, a::b and c; --namespace a is one for all.  Throws UsageError
// for a name that C++ or the emitted code has.
[[nodiscard]] EmittedSpaces emitted_spaces(const StepEquations& equations, const Request& request,
                                           const std::string& scene);

}  // namespace hamgen
