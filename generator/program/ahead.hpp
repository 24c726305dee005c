// Note [derivatives ahead]
// Where an equation takes a function that a processor needs long for, sin or exp, all else waits
// for it, it waits for the start value, and that for the step before.  But Newton's iteration takes
// derivatives at any point near the solution, and says itself whether the point was near enough. So
// those of the next step are evaluated a step ahead, by routine `derivatives` in a record `at`:
// where the solutions before this step's predict the next one, which the processor does beside the
// arithmetic of this step.  The next step's first iteration is that at this point; a second one
// evaluates at its own, as the first would have without all this.
#pragma once

#include <string>
#include <vector>

#include "generator/program/coefficients.hpp"
#include "generator/program/environment.hpp"
#include "generator/program/lowered_step.hpp"

namespace hamgen {

// The iteration's body in two: what depends on the unknowns and on parameters alone, and the rest.
struct SplitBody {
  std::vector<Statement> of_point;
  std::vector<Statement> rest;
  std::vector<std::string> wanted;  // symbols of the first part that others read
};
// Of the step's only solve.
[[nodiscard]] SplitBody split_body(const Environment& environment, const LoweredStep& lowered);

// What routines read of `at`: the point, element by element, and where the wanted symbols stand.
struct DerivativesAhead {
  Record record;
  Routine routine;
  std::vector<Place> point = {};
  CoefficientPlaces places = {};
};
[[nodiscard]] DerivativesAhead derivatives_ahead(const Environment& environment,
                                                 const LoweredStep& lowered,
                                                 const CoefficientPlaces& coefficients);

// With what the caller has by the same names.
[[nodiscard]] Call call_of(const Routine& derivatives);

}  // namespace hamgen
