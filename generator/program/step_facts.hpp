// What people are told of a step: in the first lines of what is emitted, by a plugin, after a run.
// Nothing that is computed depends on it.
#pragma once

#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

struct StepFacts {
  std::string system;       // "pendulum"
  std::string hamiltonian;  // as the user wrote it, in one line
  std::vector<std::pair<std::string, std::string>> definitions;  // of its names, each the same
  bool has_time = false;                  // is the last coordinate t, with p_t beside H?
  std::vector<Quantity> constants = {};   // parameters whose values are part of the code
  std::vector<Quantity> invariants = {};  // modified energies last
  std::vector<int> modified_powers = {};  // of h, after which the modified energies are cut off
  std::string scheme;                     // "implicit-midpoint"
  std::string properties;  // "implicit midpoint rule: order 2, symmetric, symplectic"
  std::string equations;   // from z = (q, p) to Z = (Q, P)
  std::string solver;      // "Newton of size 1; p torn out"
  std::vector<std::string> left_out = {};
  std::string cost;          // "per step: 12 + - *"
  bool needs_eigen = false;  // to be compiled
};

}  // namespace hamgen
