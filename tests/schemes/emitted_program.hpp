// Emitted headers, compiled and run as a program.
#pragma once

#include <string>

#include "generator/pipeline.hpp"

namespace hamgen::schemes_test {

inline const std::string kPendulum =
    "system pendulum\ncoordinate q\nmomentum p\nH = p^2/2 - cos(q)\n";
// Not separable, and not a polynomial.
inline const std::string kMixed =
    "system mixed\ncoordinate q\nmomentum p\nH = p^2*(1 + q^2/4)/2 - cos(q) + q*p/5\n";

// The header of a model in the namespace, without #pragma once.
[[nodiscard]] std::string header(const std::string& model, Request request,
                                 const std::string& name_space);
// What the program prints: compiled without optimisation to spare time.
[[nodiscard]] std::string output_of(const std::string& text);
// What compilers say of it with strict warnings; empty if nothing.
[[nodiscard]] std::string warnings_of(const std::string& compiler, const std::string& text);

}  // namespace hamgen::schemes_test
