// The matrices of large systems.
#pragma once

#include "generator/formats/code_writer.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// The class Matrix: clear, put, factorise, solve.
void write_matrix(CodeWriter& out, const ArrayMatrix& matrix);

}  // namespace hamgen
