// A one-step scheme as a plain value.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/algebra/sparse_matrix.hpp"

namespace hamgen {

// A member of the family of Jimenez-Perez, Vilotte and Romanowicz:
//
//   Z = z + h J grad H(zbar),   zbar = (z + Z)/2 + C (Z - z),   z = (q, p)
//
// C is 2n x 2n.  The step is symplectic for every H if and only if C J + J C^T = 0, that is
//
//   C = [[alpha - 1/2, -gamma], [-beta, 1/2 - alpha^T]],   beta and gamma symmetric.
struct Member {
  int degrees_of_freedom = 0;  // 1 in THE LIST, where it stands for any number
  SparseMatrix c = {};
  // Steps at which C has a pole, with all their multiples; empty for most members.
  std::vector<double> singular_steps = {};
  // Above 0: the step takes K of that order in place of H (mechanics/generating_function.hpp).
  int generating_order = 0;
};

// Steps of sizes substeps[0] h, substeps[1] h, ... of a symmetric member, one after the other.
struct Composition {
  Member base;
  std::vector<Expression> substeps;  // their sum is 1
};

// For H = T(p) + V(q): kicks p -= b h V'(q) and drifts q += a h T'(p) in turn.
struct Splitting {
  bool kick_first = true;
  std::vector<Expression> kicks;   // b, in the order of the step
  std::vector<Expression> drifts;  // a
};

// Z = z + h sum b_i f(Z_i),  Z_i = z + h sum a_ij f(Z_j),  f = J grad H.
struct RungeKutta {
  std::vector<std::vector<Expression>> a;
  std::vector<Expression> b, c;
  [[nodiscard]] bool is_explicit() const;  // a_ij = 0 for j >= i
};

using Method = std::variant<Member, Composition, Splitting, RungeKutta>;

struct Scheme {
  std::string name;         // "implicit-midpoint", or "member" for general parameters
  std::string description;  // "alpha = 1/2, beta = 0, gamma = 0"
  int order = 1;
  bool symmetric = false;  // the step is its own adjoint; for a member, C(-h) = -C(h)
  bool symplectic = true;
  std::string needs = "any H";  // or "separable H"
  std::string source = {};
  Method method = {};

  [[nodiscard]] bool is_member() const { return std::holds_alternative<Member>(method); }
  // The member, or the one that is composed; an internal error for a scheme without.
  [[nodiscard]] const Member& member() const;
  [[nodiscard]] bool has_member() const;
};

// A block of C as a user gives it.
struct GaugeBlock {
  // One entry for all degrees of freedom, one for each, or n x n entries row by row.
  std::vector<Expression> entries;
  bool is_matrix = false;
  // The entries as a person would write them, 0.03 for 3/100; empty: as algebra writes them.
  std::vector<std::string> words = {};
};

// "a", "a, b" or "[[a, b], [c, d]]", with `columns` entries in each row.
[[nodiscard]] std::string to_text(const GaugeBlock& block, std::size_t columns);

// The member with these blocks.  Throws UsageError on a wrong count, and on a beta or gamma that is
// not symmetric.
[[nodiscard]] Scheme family_member(int degrees_of_freedom, const GaugeBlock& alpha,
                                   const GaugeBlock& beta, const GaugeBlock& gamma);

// The member with this C, 2n x 2n; not symplectic where C J + J C^T is not 0.
[[nodiscard]] Scheme member_of_matrix(int degrees_of_freedom, SparseMatrix c);

// C J + J C^T, without the entries that algebra finds to be zero.
[[nodiscard]] SparseMatrix gauge_defect(const Member& member);

// The parameters of a member that has the same ones for all degrees of freedom and no other
// entries.
struct FamilyParameters {
  Expression alpha, beta, gamma;
};
[[nodiscard]] std::optional<FamilyParameters> uniform_parameters(const Member& member);
// C of n degrees of freedom, if the member has the entries of one that all of them share.
[[nodiscard]] Member of_all(const Member& member, int n);
[[nodiscard]] bool has_beta(const Member& member);
[[nodiscard]] bool has_gamma(const Member& member);

// The value of an entry of C as h goes to 0; empty if it has none that could be found.
[[nodiscard]] std::optional<Expression> at_zero_step(const Expression& entry);

// Steps at which the scheme has a pole, with all their multiples.
[[nodiscard]] std::vector<double> singular_steps(const Scheme& scheme);

// The matrix (1/2 + C) J of zbar = z + h (I/2 + C) J grad H(zbar).
[[nodiscard]] SparseMatrix stage_matrix(const Member& member);

// The member with the generating function of that order in place of H.  Throws UsageError where
// there is none: for a scheme that is no member, an odd order of a symmetric member, an order out
// of range.
inline constexpr int kHighestOrder = 10;
[[nodiscard]] Scheme raise_order(Scheme scheme, int order);

}  // namespace hamgen
