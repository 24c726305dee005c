// Which records a routine changes that nothing else it is given is a part of: what is read of the
// others stays as it is, and a compiler may compute many elements at once.
#pragma once

#include "generator/program/program.hpp"

namespace hamgen {

// Of all calls in the program and in a run of it.
void find_alone(Program& code);

}  // namespace hamgen
