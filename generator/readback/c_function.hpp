// A function in C as the one in C++ that does the same.
#pragma once

#include <set>
#include <string>

#include "generator/program/propagator.hpp"
#include "generator/readback/syntax.hpp"

namespace hamgen {

// `written` has the names of `cpp_words`.  Records, which C gives by their addresses, become
// references, and what the fixed blocks do members of the objects that they do it to.  Where an
// address stands for a value, or a value for an address, this throws TextDifference.
// `run`: what a run is, if the function is given one; the address of it is left out.
[[nodiscard]] CppFunction without_addresses(const CppFunction& written, const Program& code,
                                            const Propagator* run = nullptr);

}  // namespace hamgen
