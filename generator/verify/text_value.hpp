// A formula of a model's file evaluated from its text: no tree, no algebra, no table of functions'
// derivatives.
#pragma once

#include <map>
#include <string>

#include "generator/language/model.hpp"
#include "generator/verify/precise.hpp"
#include "generator/verify/sample_points.hpp"

namespace hamgen {

// The values of "q[2]", "eps", ... at one point.
using PointValues = std::map<std::string, Precise>;

// Throws std::domain_error where the formula has no value, and an internal error for a text that is
// none of the language: it has been accepted before.
[[nodiscard]] ScaledValue evaluate_text(const Model& model, const std::string& text,
                                        const PointValues& point);

}  // namespace hamgen
