// An oracle that says if routines with one thing changed still compute the same.
#pragma once

#include "generator/program/step_code.hpp"

namespace hamgen::verify_test {

// By evaluating both in double, which shares nothing with the proof.
[[nodiscard]] bool computes_the_same(const StepCode& a, const StepCode& b);

}  // namespace hamgen::verify_test
