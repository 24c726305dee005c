// An oracle that says if routines with one thing changed still compute the same.
#pragma once

#include "generator/program/program.hpp"

namespace hamgen::verify_test {

// By evaluating both in double, which shares nothing with the proof.
[[nodiscard]] bool computes_the_same(const Program& a, const Program& b);

}  // namespace hamgen::verify_test
