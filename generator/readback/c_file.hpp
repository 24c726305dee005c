// A header in C read back: see read_back.hpp.
#pragma once

#include "generator/base/c_family.hpp"
#include "generator/readback/read_back.hpp"
#include "generator/readback/shell.hpp"
#include "generator/readback/tokens.hpp"

namespace hamgen {

// The language of a header in C, as it opens; null of another file.
[[nodiscard]] const CFamily* family_of(std::span<const CppToken> tokens);
// Fills in what was found.  Throws TextDifference and TextNotUnderstood.
void read_c_file(std::span<const CppToken> tokens, const Precision& precision,
                 const Program& program, ReadBack& found);

}  // namespace hamgen
