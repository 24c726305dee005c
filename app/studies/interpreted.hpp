// Integrators without a compiler: the routines of a step, interpreted behind the interface that
// compiled ones have.
#pragma once

#include "generator/pipeline.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::app {

// What load_integrator would give, of the same step: the same bits, but that functions of <cmath>
// are those of this program.  One at a time.
[[nodiscard]] runtime::LoadedPlugin interpreted_integrator(const SourceText& source,
                                                           const Request& request,
                                                           const PluginSource& plugin);

}  // namespace hamgen::app
