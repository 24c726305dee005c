// What can be proved of schemes that are not one member.
#include <fmt/format.h>

#include "generator/verify/proof.hpp"

namespace hamgen {

namespace {

// The tableau's numbers have 70 digits; what is below this is their rounding.
const Rational kRounding(Integer(1), Integer(1) << 200);

std::string decimal_text(const Rational& value) { return fmt::format("{:.6g}", to_double(value)); }

}  // namespace

// The Jacobian of a kick is [[1, 0], [-b h V'', 1]], of a drift [[1, a h T''], [0, 1]]; V'' and T'' are
// symmetric, so both are in Sp(2n), and so is their product.
Finding prove_splitting_symplectic() {
  return {"symplectic", Verdict::proved,
          "kicks and drifts are the exact flows of V(q) and T(p), shears by symmetric matrices"};
}

// Cooper 1987; HLW VI.4: b_i a_ij + b_j a_ji - b_i b_j = 0, and for irreducible methods only then.
Finding prove_tableau_symplectic(const RungeKutta& tableau) {
  for (std::size_t i = 0; i < tableau.b.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const Expression residual = tableau.b[i] * tableau.a[i][j] + tableau.b[j] * tableau.a[j][i] -
                                  tableau.b[i] * tableau.b[j];
      const Rational value = numeric_value(residual);
      if (abs(value) <= kRounding) continue;
      return {"symplectic", Verdict::refuted,
              fmt::format("b_i a_ij + b_j a_ji - b_i b_j is {} for i = {}, j = {}",
                          decimal_text(value), i + 1, j + 1)};
    }
  }
  return {"symplectic", Verdict::proved,
          "b_i a_ij + b_j a_ji = b_i b_j to 60 digits; for exactly solved steps"};
}

}  // namespace hamgen
