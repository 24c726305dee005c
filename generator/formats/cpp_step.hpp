// The records and routines of a step in C++, and around them what takes steps: the function step
// and the class Propagator.
#pragma once

#include "generator/formats/cpp_context.hpp"

namespace hamgen {

void write_record(CodeWriter& out, const Record& record, const ScalarType& scalar);

// Do the routines that are written use blocks of numerics/ with a vocabulary of their own, or
// Eigen?
[[nodiscard]] bool needs_vocabulary(const CppContext& context);
[[nodiscard]] bool needs_eigen(const CppContext& context);

// prepare, the blocks of numerics/ that solve needs, the records it works with, and solve.
void write_solver(CodeWriter& out, CppContext& context);
// step(par, h, z) and the class Propagator.
void write_steps(CodeWriter& out, const CppContext& context);

// The functions advance(), state() and carry() of a class with step(), z_ and carry_.
void write_advance(CodeWriter& out);

}  // namespace hamgen
