// Emitted text as a part of the proof: read back and held against the program.
#pragma once

#include "generator/readback/read_back.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {

// The line "emitted code", below that of the program, on which it rests; `path` is where the text
// was found, empty if it was made here.
void add_emitted_code(const ReadBack& read, const std::string& path, Proof& proof);
// The line "plugin" below it: the text that `hamgen run` compiles.
void add_plugin(const ReadBack& read, Proof& proof);

}  // namespace hamgen
