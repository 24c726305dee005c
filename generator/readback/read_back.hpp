// The emitted file read back: a header in C++ or C, or a plugin, is turned into functions again,
// and these are compared with the routines of the program, operation by operation.
//
// Independent of what prints it: formats/ has no part in it, and only what an instruction is as
// statements, program/written_code.hpp, is shared with it.  Comments, the width of lines, the
// names of locals, brackets and digits of numbers are free, nothing else is: what is not the
// program's is a difference, and what cannot be read leaves the question open.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "generator/program/program.hpp"

namespace hamgen {

struct EmittedFile {
  std::string_view text;
  std::string_view scalar;  // "" is double
  // Files beside it by their names, of which it may include "hamgen_support.hpp".
  std::map<std::string, std::string> beside = {};
  // The step at which a plugin has the modified energies among its invariants.
  Rational watched_step = 0;
  // Of a batch: its trajectories; 0 where there is one alone.
  int lanes = 0;
};

// What a text says it is, by its first lines.
enum class TextKind { header, plugin, c_header };

struct ReadBack {
  enum class Outcome { same, different, not_understood };
  Outcome outcome = Outcome::not_understood;
  TextKind kind = TextKind::header;
  int line = 0;      // of the first difference, or of what is not understood
  std::string what;  // the difference
  int routines = 0;  // that were compared, with so many instructions
  int instructions = 0;
  int blocks = 0;  // of fixed text
  int places = 0;  // of a plugin's arrays of parameters and of the state
};

[[nodiscard]] ReadBack read_back(const EmittedFile& file, const Program& program);

}  // namespace hamgen
