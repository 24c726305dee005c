// Checks the settings of a scene: names, elements, counts.
#pragma once

#include "generator/language/check_values.hpp"
#include "generator/language/symbols.hpp"
#include "generator/language/syntax.hpp"

namespace hamgen {

// The scene with its free indices told from fixed subscripts.  Reports every mistake.
[[nodiscard]] Scene check_scene(const SceneStatement& statement, const KnownValues& known,
                                Symbols& symbols);

// What is observed exists, or has a name of its own.
void check_observed(const std::vector<Observed>& list, const KnownValues& known, Symbols& symbols);

// One setting: "q[i] = sin(i)", from a scene or from the command line.
void check_setting(Setting& setting, const KnownValues& known, Symbols& symbols);

}  // namespace hamgen
