// What the front end made of the text of a model's file is held against the text.
#pragma once

#include <string>
#include <vector>

#include "generator/language/model.hpp"
#include "generator/mechanics/mechanics.hpp"
#include "generator/verify/proof.hpp"
#include "generator/verify/sample_points.hpp"

namespace hamgen {

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
[[nodiscard]] std::string point_beyond_text(const Model& model, const Mechanics& mechanics);

}  // namespace hamgen
