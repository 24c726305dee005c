// Steps that do not carry along what rounding takes from the state: --plain-sums.
#pragma once

#include "generator/program/program.hpp"

namespace hamgen {

// The same routines from z alone: there is no `carry`, and `rest`, what is small of an increment,
// is added to it.  What is left is z += dz, of which rounding takes half a unit of z at every step.
void use_plain_sums(Program& code);

}  // namespace hamgen
