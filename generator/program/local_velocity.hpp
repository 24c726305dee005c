// dT/dp where element j of it is a function of element j of the momenta alone: a loop that has the
// momentum can go on with it, and needs no array of velocities.
#pragma once

#include <optional>
#include <string>

#include "generator/program/environment.hpp"
#include "generator/program/lowered_step.hpp"

namespace hamgen {

struct LocalVelocity {
  std::string momentum;   // the symbol of element j
  Evaluation evaluation;  // one result
  std::map<std::string, Place> places;
};
// Of a system in loops whose elements from 0 on one kernel meets, each of them once.
[[nodiscard]] std::optional<LocalVelocity> local_velocity(const Mechanics& mechanics);

}  // namespace hamgen
