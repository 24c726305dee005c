// What a computation is that can be gone on with: two with the same lines do the same, bit for bit.
#pragma once

#include <string>
#include <vector>

#include "app/studies/load_integrator.hpp"
#include "app/studies/setting.hpp"

namespace hamgen::app {

// Of hamgen, model, method, code and scene, one line each: a label of 10 columns and a value.  No
// path and no time.  Throws what chosen_compiler throws.
[[nodiscard]] std::vector<std::string> manifest_lines(const Setting& setting,
                                                      const SceneValues& scene,
                                                      const PluginSource& plugin,
                                                      const CompilerChoice& compiler);

// The lines that differ, "there" and "here"; empty if none do.
[[nodiscard]] std::string difference_of(const std::vector<std::string>& there,
                                        const std::vector<std::string>& here);

}  // namespace hamgen::app
