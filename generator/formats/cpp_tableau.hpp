// The numbers of an implicit Runge-Kutta method in C++.
#pragma once

#include "generator/formats/code_writer.hpp"
#include "generator/formats/scalar.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// stages, weight[], coupling[][], ahead[][].  The method must be symplectic: b_i a_ij + b_j a_ji =
// b_i b_j.
void write_tableau(CodeWriter& out, const ScalarType& scalar, const StageTable& table,
                   const std::vector<Expression>& nodes);

}  // namespace hamgen
