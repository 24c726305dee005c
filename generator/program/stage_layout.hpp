// Where an implicit Runge-Kutta method keeps its stages: in arrays of all components of them all.
#pragma once

#include "generator/mechanics/kernel.hpp"

namespace hamgen {

// One stage after the other, as the state has its components, where the system is in loops.  Else
// one component after the other, with its numbers of all stages side by side: as they are computed,
// many at once or not.  Beyond the last stage there may be room then, for stages that stay at z and
// that nothing takes anything of.
struct StageLayout {
  int stages = 0;
  int dimension = 0;  // 2n
  int lanes = 0;      // 0: one stage after the other; else how many are computed at once

  [[nodiscard]] bool by_component() const { return lanes > 0; }
  // Are numbers packs of this size?
  [[nodiscard]] int packs() const { return lanes > 1 ? lanes : 0; }
  // Of a component's numbers.
  [[nodiscard]] int room() const {
    return by_component() ? (stages + lanes - 1) / lanes * lanes : stages;
  }
  [[nodiscard]] int count() const { return room() * dimension; }
  [[nodiscard]] long at(long stage, long component) const {
    return by_component() ? component * room() + stage : stage * dimension + component;
  }
  // The same without that room: where rows and columns of a matrix are.
  [[nodiscard]] StageLayout without_room() const {
    StageLayout result = *this;
    if (by_component()) result.lanes = 1;
    return result;
  }
  // Component `component` of stage `stage`, or with indices of these names as well.
  [[nodiscard]] AffineIndex index(const std::string& stage_index, long stage,
                                  const std::string& component_index, long component) const {
    AffineIndex result{at(stage, component), {}};
    if (!stage_index.empty()) result.factors[stage_index] = at(1, 0);
    if (!component_index.empty()) result.factors[component_index] = at(0, 1);
    return result;
  }
};

// By component, with as many lanes as fit: the fewest numbers that are none of a stage, of these
// the widest.
[[nodiscard]] StageLayout stages_in_lanes(int stages, int dimension);

}  // namespace hamgen
