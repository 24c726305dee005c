// What becomes of a run, and of a cell of a map.
#pragma once

#include <string_view>

namespace hamgen::runtime {

// Of the runtime, of the steps of a run, and of the cells of a map.
enum class Status {
  done,           // all steps that were asked for
  jumped,         // an energy error beyond the energy scale: a singularity was stepped across, or
                  // the step is far too large for this solution
  escaped,        // far away from where it began, with its energy kept beside the terms of H there;
                  // perhaps to infinity in finite time, where no step can follow
  not_converged,  // the equations of a step were not solved
  left_domain,    // H or its gradient is not defined where the step went
  overflow,       // beyond the numbers there are, or a matrix without an inverse
  stopped,        // by the user
  out_of_time,    // its time was over before its steps
  undefined,      // there are no values to begin with: nothing was run
};
// How many there are.
inline constexpr int kStatuses = 9;

// "done", "jumped", "escaped", "not converged", "left the domain", "overflow", "stopped",
// "out of time", "undefined".
[[nodiscard]] std::string_view to_text(Status status);

}  // namespace hamgen::runtime
