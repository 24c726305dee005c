// dT/dp where an element of it is a function of the same element of the momenta alone: a loop that
// has the momentum can go on with it, and needs no array of velocities.
#pragma once

#include <optional>
#include <string>

#include "generator/program/environment.hpp"
#include "generator/program/lowered_step.hpp"

namespace hamgen {

struct LocalVelocity {
  std::string momentum;   // the symbol of the element
  Evaluation evaluation;  // one result
  std::map<std::string, Place> places;
  std::set<int> terms;  // of H that it comes from

  // The statements before its value.
  void compute(Body& body) const;
};
// Of a system in loops whose elements one kernel meets, each of them once; the loop that goes on
// has them from 0 on by this index.
[[nodiscard]] std::optional<LocalVelocity> local_velocity(const Mechanics& mechanics,
                                                          const std::string& index);

}  // namespace hamgen
