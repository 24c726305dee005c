#include "generator/program/stage_layout.hpp"

namespace hamgen {

StageLayout stages_in_lanes(int stages, int dimension) {
  StageLayout best{.stages = stages, .dimension = dimension, .lanes = 1};
  for (const int lanes : {8, 4, 2}) {
    if (lanes >= 2 * stages) continue;  // half of them, at least, are of a stage
    const StageLayout layout{.stages = stages, .dimension = dimension, .lanes = lanes};
    // Two are what every machine has: more of them at once repay some that are none.
    const bool wider = best.lanes == 1 || (lanes > 2 && layout.room() < best.room());
    if (wider) best = layout;
  }
  return best;
}

}  // namespace hamgen
