// Where an implicit Runge-Kutta method keeps its stages: in arrays of all components of them all.
#pragma once

#include "generator/mechanics/kernel.hpp"

namespace hamgen {

// One stage after the other, as the state has its components, or one component after the other,
// with its numbers of all stages side by side: so they are computed in lanes.  Beyond the last
// stage there may be room then, for stages that stay at z and that nothing takes anything of.
struct StageLayout {
  int stages = 0;
  int dimension = 0;  // 2n
  int lanes = 0;      // that are computed together: 2, 4 or 8, or 0 where stages follow each other

  // Of a component's numbers, in lanes.
  [[nodiscard]] int room() const {
    return lanes == 0 ? stages : (stages + lanes - 1) / lanes * lanes;
  }
  [[nodiscard]] int count() const { return room() * dimension; }
  [[nodiscard]] long at(long stage, long component) const {
    return lanes == 0 ? stage * dimension + component : component * room() + stage;
  }
  // The same without that room: where rows and columns of a matrix are.
  [[nodiscard]] StageLayout without_room() const {
    StageLayout result = *this;
    if (lanes > 0) result.lanes = 1;
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

// With as many lanes as fit: the fewest numbers that are none of a stage, of these the widest.
[[nodiscard]] StageLayout stages_in_lanes(int stages, int dimension);

}  // namespace hamgen
