// What a plugin has behind the text of a header: the functions that runtime/plugin.h wants, which
// say at which place of the host's arrays each parameter and each part of the state stands.
#pragma once

#include <string>
#include <vector>

#include "generator/readback/pattern.hpp"
#include "generator/readback/shell.hpp"

namespace hamgen {

struct InterfaceFacts {
  const Program& program;
  const Precision& precision;
  std::string system;  // the namespace of the system
  std::string space;   // the namespace of the method
  bool tangent = false;
  Rational watched_step = 0;  // at which the modified energies are taken
};

// Piece by piece, in their order: the name of a piece and its text.
struct InterfacePiece {
  std::string name;
  Pattern pattern;
};
[[nodiscard]] std::vector<InterfacePiece> plugin_interface(const InterfaceFacts& facts);

}  // namespace hamgen
