// The parts of an emitted header that do not depend on the mathematics: each is emitted only where
// a step uses it.
#pragma once

#include <string>

#include "generator/formats/scalar.hpp"

namespace hamgen {

// |x|: the compiler's own function where no header is wanted.
[[nodiscard]] std::string cpp_magnitude(const ScalarType& scalar, bool builtins);
// Adding with a carry (compensated summation).
[[nodiscard]] std::string cpp_compensated_sum();
// Adding an increment that holds the carry already.
[[nodiscard]] std::string cpp_two_sum();
// Adding an increment and a small rest, the carry in it, with two_sum.
[[nodiscard]] std::string cpp_sum_with_rest();
// Adding with what rounding loses summed up, with two_sum.
[[nodiscard]] std::string cpp_collected_sum();
// When to stop Newton's iteration; simplified, with an approximate matrix, it converges linearly.
[[nodiscard]] std::string cpp_newton_rule(const ScalarType& scalar, bool simplified = false);
// When to stop a fixed-point iteration of `size` unknowns.
[[nodiscard]] std::string cpp_fixed_point_rule(const ScalarType& scalar);
// Start values from earlier steps, for `unknowns` of them.
[[nodiscard]] std::string cpp_history(int unknowns);
// Gaussian elimination with partial pivoting; with Eigen where the system is large.
[[nodiscard]] std::string cpp_elimination(const ScalarType& scalar);
[[nodiscard]] std::string cpp_inverse();
[[nodiscard]] std::string cpp_eigen_solve();

}  // namespace hamgen
