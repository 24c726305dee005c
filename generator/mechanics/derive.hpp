// Model to Mechanics: the symbolic derivatives.
#pragma once

#include "generator/language/model.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

// Throws ModelError where the mathematics is undefined or not real, with the place in the source.
// With keep_sums, the sums of a system with more than `most` degrees of freedom stay loops if their
// form allows it.
inline constexpr int kMostWrittenOut = 24;
[[nodiscard]] Mechanics derive(const Model& model, bool keep_sums = true,
                               int most = kMostWrittenOut);
// H with its sums written out, whatever its size.
[[nodiscard]] Expression written_out_hamiltonian(const Model& model);

// A free-standing expression over h, E0 and the model's parameters (folded ones by value).
[[nodiscard]] Expression scheme_parameter(const Model& model, const std::string& option,
                                          const NodePtr& node);

}  // namespace hamgen
