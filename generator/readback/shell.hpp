// What stands around the routines of an emitted C++ file, as it has to be for this step: records,
// the class that takes steps, the functions that call routines.
#pragma once

#include "generator/program/program.hpp"
#include "generator/readback/pattern.hpp"

namespace hamgen {

struct ShellFacts {
  const Program& code;
  bool arrays = false;                  // is the state two arrays of n?
  std::string time;                     // the field of State that is the time; empty: there is none
  int modified = 0;                     // how many modified energies there are
  std::vector<std::string> state = {};  // places of z_1..z_2n in State: "q", "q[2]"
};

// Its name and base are not part of it: "{ Real eps = 0.1; ... };"
[[nodiscard]] Pattern record_pattern(const Record& record);
[[nodiscard]] Pattern propagator_pattern(const ShellFacts& facts);
[[nodiscard]] Pattern step_pattern(const ShellFacts& facts);
[[nodiscard]] Pattern modified_energy_pattern(const ShellFacts& facts);
[[nodiscard]] Pattern gradient_pattern();
// "using Matrix = BandMatrix<8, 1>;" with what it needs.
[[nodiscard]] Pattern matrix_pattern(const ArrayMatrix& matrix);

}  // namespace hamgen
