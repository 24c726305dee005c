// A large system in C++: State has Real q[n], p[n], and sums are loops.
#pragma once

#include "generator/formats/cpp_context.hpp"
#include "generator/formats/cpp_member.hpp"

namespace hamgen {

// energy(par, z); gradient(par, x, values) and, for separable H, potential_gradient and
// kinetic_gradient, which add; matrices and hessian(par, x, put) where the plan solves with them.
void write_array_functions(CodeWriter& out, CppContext& context);
// The class that takes many steps of a member.
void write_array_propagator(CodeWriter& out, const CppContext& context, StepRole role);

// class BandMatrix, class SparseMatrix: clear, put, factorise, solve.
void write_band_matrix(CodeWriter& out, int width);
void write_sparse_matrix(CodeWriter& out);

}  // namespace hamgen
