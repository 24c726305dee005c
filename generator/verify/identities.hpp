// Many equations between expressions, to be decided together: what an emitted program computes
// against what it should.
#pragma once

#include <string>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/verify/corners.hpp"
#include "generator/verify/sample_points.hpp"
#include "generator/verify/verdict.hpp"

namespace hamgen {

struct Claim {
  std::string what;  // "increment of q"
  Expression emitted;
  Expression expected;
  // Of points where a matrix that is solved is regular: there only is the emitted side defined.
  bool where_regular = false;
};

// Symbols without a definition are free: the claims hold for all their values.  A definition of the
// expected side is named "=x" if it is what the definition x of the emitted side should be; such
// pairs are proved first and then count as one symbol, which keeps the expressions small.
struct Identities {
  std::vector<Statement> emitted;  // definitions, in the order in which they are computed
  std::vector<Statement> expected;
  std::vector<Claim> claims;
};

// How well the claims are known.  `proved`: every difference is zero after normalisation, and no
// side has a corner.  `tested`: at `points` random points the sides differ by less than 1e-40 of
// the terms they are made of.  `refuted`: the witness says which claim fails, where and by how
// much.
struct Decision {
  Verdict verdict = Verdict::not_decided;
  int claims = 0;
  int by_algebra = 0;  // of them
  int points = 0;
  std::string witness;
  std::vector<Corner> corners;  // that the points were off
};

// What a program computes: an emitted value that is not defined where the expected one is refutes
// the claim.
[[nodiscard]] Decision decide(const Identities& identities, const Surroundings& around = {});
// Two expressions, at points where both are defined.
[[nodiscard]] Decision decide_equal(const std::string& what, const Expression& a,
                                    const Expression& b, const Surroundings& around = {});

// "12 identities by algebra", or with the number of points.
[[nodiscard]] std::string to_text(const Decision& decision);
// How a claim is known that is not proved: "at 200 points around the scenes, of both signs and
// several scales, to 1e-40 of their terms", or by algebra, and which corners that is off.
[[nodiscard]] std::string points_text(const Decision& decision);

}  // namespace hamgen
