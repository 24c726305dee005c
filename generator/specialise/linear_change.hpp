// New variables by a linear point transformation with rational entries, in which a scene needs
// fewer degrees of freedom.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"
#include "generator/specialise/scene_facts.hpp"

namespace hamgen {

// The nonzero entries by (row, column), from 0.
using SparseRationalMatrix = std::map<std::pair<int, int>, Rational>;

// Note [a step in new variables]
// z = L Z with q = A Q, p = B P and A^T B = 1, so that R = (B^T, A^T) takes Z from z, and L carries
// the symplectic form of the Z into that of the z.  Let H'(Z) = H(L Z), and W the image of L.  If
//   J grad H(L Z) = L J grad H'(Z)  and  C L = L C',
// a step from L Z is L times the step of H' and C' from Z: stages of a Runge-Kutta method are L
// times stages, so are kicks and drifts, for q and p are not mixed, so that each half of the first
// equation holds by itself; and with zbar = L Zbar a member's equations
//   zbar = z + h (I/2 + C) J grad H(zbar)   are   L (Zbar - Z - h (I/2 + C') J grad H'(Zbar)) = 0.
// Where A is square the first equation is the chain rule.  Where it is not, W is a subspace that
// the flow, and with C each stage, does not leave.
struct LinearChange {
  int from = 0, to = 0;             // degrees of freedom
  SparseRationalMatrix a, b;        // from x to
  std::vector<Quantity> variables;  // 2 to: the new ones
  // A parameter, and one of the same value in the scene that takes its place.
  std::vector<std::pair<std::string, std::string>> united = {};
  std::vector<std::string> left_out = {};  // one line each

  // L, 2 from x 2 to, and R.
  [[nodiscard]] SparseRationalMatrix embedding() const;
  [[nodiscard]] SparseRationalMatrix projection() const;
};
[[nodiscard]] SparseRationalMatrix product(const SparseRationalMatrix& a,
                                           const SparseRationalMatrix& b);

// Each parameter's name with the symbol that takes its place.
[[nodiscard]] Substitution united_parameters(
    const std::vector<std::pair<std::string, std::string>>& united, const Expression& energy);
// What stands for the variables of the old system in the new one.
[[nodiscard]] Substitution new_variables(const LinearChange& change, const Mechanics& mechanics);
[[nodiscard]] Mechanics in_new_variables(const LinearChange& change, const Mechanics& mechanics);
// Empty where C does not respect the change, C L != L C'.
[[nodiscard]] std::optional<Scheme> in_new_variables(const LinearChange& change,
                                                     const Scheme& scheme);
[[nodiscard]] SceneFacts in_new_variables(const LinearChange& change, SceneFacts scene);

// Degrees of freedom that move as others do, or as their mirror images: H does not change where
// they are exchanged, with signs, and the scene begins so.  Equal values of parameters that are not
// kept count as equal.  Of those that are their own mirror images these are not looked for: they
// rest anyway.  Empty if there are none, and where sums stay loops.
[[nodiscard]] std::optional<LinearChange> by_symmetry(const Mechanics& mechanics,
                                                      const SceneFacts& scene,
                                                      const std::vector<int>& resting);
// Coordinates relative to the last of several, where neither H nor the system's invariants change
// if all of them move by the same, and `observed`, names of variables, has none of them.  Empty if
// there are none, and where sums stay loops.
[[nodiscard]] std::optional<LinearChange> by_translation(const Mechanics& mechanics,
                                                         const std::set<std::string>& observed);

}  // namespace hamgen
