// The scheme that a request means for a system.
#pragma once

#include "generator/pipeline.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

// A scheme of THE LIST by its name, or the member that alpha, beta, gamma or the gauge choose,
// raised to the order asked for.  Throws UsageError where the request contradicts itself or the
// scheme does not suit the system, ModelError for a wrong expression.
[[nodiscard]] Scheme choose_scheme(const Model& model, const Mechanics& mechanics,
                                   const Request& request);

}  // namespace hamgen
