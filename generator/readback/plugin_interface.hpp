// What a plugin has behind the text of a header: the functions that runtime/plugin.h wants, which
// say at which place of the host's arrays each parameter and each part of the state stands.
#pragma once

#include <string>
#include <vector>

#include "generator/readback/pattern.hpp"
#include "generator/readback/shell.hpp"

namespace hamgen {

// What the host's arrays hold, in their order: elements of one array one after the other.
struct InterfaceQuantity {
  std::string name;  // "q", "m[2]"
  std::string unit, comment;
};
struct InterfaceLists {
  std::vector<InterfaceQuantity> variables;
  std::vector<InterfaceQuantity> parameters;
  std::vector<InterfaceQuantity> invariants;
};

struct InterfaceFacts {
  const ShellFacts& shell;
  const Precision& precision;
  std::string system;                   // the namespace of the system
  std::string space;                    // the namespace of the method
  int degrees_of_freedom = 0;           // n
  std::vector<std::string> parameters;  // places in Parameters, in the order of the host's array
  std::vector<std::string> state;       // places in State of z_1..z_2n
  int invariants = 0;                   // that the routine of this name fills in
  InterfaceLists named;
  bool tangent = false;
  Rational watched_step;  // at which the modified energies are taken
  std::string description, solver;
};

// Piece by piece, in their order: the name of a piece and its text.
struct InterfacePiece {
  std::string name;
  Pattern pattern;
};
[[nodiscard]] std::vector<InterfacePiece> plugin_interface(const InterfaceFacts& facts);

}  // namespace hamgen
