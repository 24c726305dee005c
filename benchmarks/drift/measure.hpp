// Does rounding make a conserved quantity drift?  A method is emitted in its scalar and in quad,
// compiled with the flags of `hamgen run`, and run from many starts.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "generator/pipeline.hpp"

namespace hamgen::drift {

// What a run of exact arithmetic would keep, evaluated in quad from state + carry.
enum class Conserved {
  // omega(z, Z) of a step from z to Z in quad: of a quadratic H the step is a linear symplectic map
  // M, and z^T J M z one of its invariants, whichever the method.
  form,
  energy,
  invariant  // the model's first one
};

struct Row {
  std::string name;     // "implicit-midpoint, closed form"
  std::string problem;  // "oscillator"
  std::string model;    // its text
  Request request;
  Conserved conserved = Conserved::form;
  double h = 0.1;
  // Statements that fill z[0..2n) from uniform(), uniform in (-1, 1), and the number s of the
  // start.
  std::string start = "for (double& value : z) value = uniform();";
  bool is_exempt = false;         // not symplectic: listed, not judged
  std::string scalar = "double";  // or "float"
};

struct Result {
  int starts = 0;
  long long steps = 0;
  double mean = 0.0;            // of the error after all steps, relative to the quantity
  double standard_error = 0.0;  // of that mean
  // Root mean square of the rates that each start has of its own, in units of rounding a step: that
  // some go up and others down hides them in the mean.  And how likely random walks are to look so.
  double own_rate = 0.0;
  double chance = 1.0;
  double nanoseconds = 0.0;  // of processor time a step
  double unit = 0x1p-52;     // of rounding
  std::string solver;

  // Is |mean| more than 4 standard errors and 1e-4 units of rounding a step, or the starts' own
  // rate more than is as likely, and than 1e-4 units?
  [[nodiscard]] bool drifts() const;
  // Of rounding, a step.
  [[nodiscard]] double units() const;
};

struct Length {
  long long steps = 6'000'000;
  int starts = 32;
  double seconds = 600;  // of processor time, after which no start begins but the first four
  // If more than 1: the header of a batch of so many (`--batch`), and so many starts side by side.
  // Its steps look at their solver less often than those of one trajectory, whose bits are others.
  int lanes = 1;
};

using Edit = std::function<std::string(const std::string&)>;

// `edit` changes the emitted header that rounds, `flags` come after those of `hamgen run`.  Throws
// std::runtime_error with the compiler's or the program's words.
[[nodiscard]] Result measure(const Row& row, const Length& length, const Edit& edit = {},
                             const std::vector<std::string>& flags = {});

}  // namespace hamgen::drift
