// The scheme that a request means for a system.
#pragma once

#include "generator/pipeline.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

// Throws UsageError where it is clear before anything is derived that the gauge of the request
// would be dense: of a large system its derivatives take long.
void require_few_coupled(const Model& model, const Request& request);

// A scheme of THE LIST by its name, or the member that alpha, beta, gamma or the gauge choose,
// raised to the order asked for.  Throws UsageError where the request contradicts itself or the
// scheme does not suit the system, ModelError for a wrong expression.
[[nodiscard]] Scheme choose_scheme(const Model& model, const Mechanics& mechanics,
                                   const Request& request);

}  // namespace hamgen
