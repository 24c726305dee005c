// H as the sum that its author wrote: what emitted lines come from.
#pragma once

#include <vector>

#include "generator/language/model.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

// The summands of H at its plus and minus signs, outside of functions, products and sums over
// indices; their variables are left to who knows the expressions.
struct WrittenTerm {
  NodePtr node;
  EnergyTerm term;
};
[[nodiscard]] std::vector<WrittenTerm> written_terms(const Model& model);

// The terms of H that a place of its text lies in; all of them for a place outside, in a
// definition.
[[nodiscard]] std::set<int> terms_around(const std::vector<WrittenTerm>& terms, const Span& span);

}  // namespace hamgen
