// solve(par, k, h, z, carry, start, dz): dz = Z - z for one step of a member from z + carry.
#pragma once

#include "generator/program/ahead.hpp"
#include "generator/program/coefficients.hpp"
#include "generator/program/environment.hpp"

namespace hamgen {

struct SolveParts {
  bool coefficients = false;  // is there a record k?
  bool inverse = false;       // and in it inverted matrices, unless they were singular?
  bool start = false;         // are there start values?
  const DerivativesAhead* ahead = nullptr;
};

[[nodiscard]] Routine solve_routine(const Environment& environment, const LoweredStep& lowered,
                                    const SolveParts& parts, const CoefficientPlaces& coefficients);

}  // namespace hamgen
