// A formula of a model's file evaluated from its text: no tree, no algebra, no table of functions'
// derivatives.  What the front end made of the text is held against it.
#pragma once

#include <map>
#include <string>

#include "generator/language/model.hpp"
#include "generator/mechanics/mechanics.hpp"
#include "generator/verify/precise.hpp"
#include "generator/verify/proof.hpp"
#include "generator/verify/sample_points.hpp"

namespace hamgen {

// The values of "q[2]", "eps", ... at one point.
using PointValues = std::map<std::string, Precise>;

// Throws std::domain_error where the formula has no value, and an internal error for a text that is
// none of the language: it has been accepted before.
[[nodiscard]] ScaledValue evaluate_text(const Model& model, const std::string& text,
                                        const PointValues& point);

inline constexpr const char* kModelRead = "model";

// H is that of the file, and so are its gradient, by differences of H, and the invariants: at
// random points, in 60 digits.  `hamiltonian` is H written out, as derived; without `gradient` and
// `invariants` they are not looked at.
struct DerivedFormulas {
  Expression hamiltonian;
  std::vector<Expression> gradient;
  std::vector<NamedExpression> invariants;
};
[[nodiscard]] Finding prove_model_read(const Model& model, const Mechanics& mechanics,
                                       const DerivedFormulas& derived,
                                       const Surroundings& around = {});

// A point at which H as the file has it has no value, and H as derived has one, for something has
// cancelled: (q^(1/3))^3 is q.  Empty if none was met at random points, or where sums stay loops.
[[nodiscard]] std::string point_beyond_text(const Model& model, const Mechanics& mechanics,
                                            const Surroundings& around = {});

}  // namespace hamgen
