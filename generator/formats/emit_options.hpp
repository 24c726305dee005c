// What all formats are told besides the program.
#pragma once

#include <string>

#include "generator/algebra/exact.hpp"

namespace hamgen {

// The namespaces of an emitted file, or what its names begin with.
struct EmittedSpaces {
  std::string system;  // "pendulum", "my::pendulum": of Real, Parameters, State, energy, ...
  std::string method;  // "implicit_midpoint": of step and Propagator, inside it; empty: the same
  [[nodiscard]] std::string of_method() const {
    return method.empty() ? system : system + "::" + method;
  }
};

struct EmitOptions {
  std::string file_name;  // without an ending
  std::string command;    // as the user typed it
  std::string model_path;
  std::string model_digest;  // SHA-256 of its text
  std::string scalar;        // name of a scalar, "" is double
  EmittedSpaces spaces;
  // What is proved, tested and refuted of the step, for the first lines; empty: not looked at.
  std::string proved, tested, refuted;
  bool tangent = false;         // emit the linearised step too
  bool shared_support = false;  // include the fixed blocks instead of writing them
  // Where a plugin, whose interface has no h there, adds the modified energies to its invariants.
  Rational watched_step = {};
  bool builtins = false;  // functions of the compiler instead of <cmath>
  // Of a batch: trajectories that are stepped together, 0 for one alone, and whether elementary
  // functions are the library's, lane by lane, instead of blocks of our own.
  int lanes = 0;
  bool library_functions = false;
};

}  // namespace hamgen
