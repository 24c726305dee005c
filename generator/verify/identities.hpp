// Many equations between expressions, to be decided together: what an emitted program computes
// against what it should.
#pragma once

#include <string>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/program/program.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {

struct Claim {
  std::string what;  // "increment of q"
  Expression emitted;
  Expression expected;
};

// Symbols without a definition are free: the claims hold for all their values.  A definition of the
// expected side is named "=x" if it is what the definition x of the emitted side should be; such
// pairs are proved first and then count as one symbol, which keeps the expressions small.
struct Identities {
  std::vector<Statement> emitted;  // definitions, in the order in which they are computed
  std::vector<Statement> expected;
  std::vector<Claim> claims;
};

// How well the claims are known.  `proved`: every difference is zero after normalisation.
// `tested`: equal to 1e-30 of their size at `points` random points.  `refuted`: the witness says
// which claim fails, where and by how much.
struct Decision {
  Verdict verdict = Verdict::not_decided;
  int claims = 0;
  int by_algebra = 0;  // of them
  int points = 0;
  std::string witness;
};

[[nodiscard]] Decision decide(const Identities& identities);

// "12 identities by algebra", or with the number of points.
[[nodiscard]] std::string to_text(const Decision& decision);

// Is the expression zero by algebra?  False also where that takes too long to find out.
[[nodiscard]] bool is_zero_by_algebra(const Expression& e);

}  // namespace hamgen
