// A one-step scheme as a plain value.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// A member of the family of Jimenez-Perez, Vilotte and Romanowicz:
//
//   Z = z + h J grad H(zbar),   zbar = (z + Z)/2 + C (Z - z),   z = (q, p)
//
// C is 2n x 2n, kept as its nonzero entries.  For alpha, beta, gamma per degree of freedom
// C = [[alpha - 1/2, -gamma], [-beta, 1/2 - alpha]] with diagonal blocks.
struct Member {
  int degrees_of_freedom = 0;  // 0 in THE LIST: made for a system by for_system
  std::map<std::pair<int, int>, Expression> c = {};  // zero entries are absent
  // How the user said it, one entry per degree of freedom (or one for all of them).
  std::vector<Expression> alpha = {}, beta = {}, gamma = {};
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
  bool symmetric = false;   // the step is its own adjoint; for a member, C(-h) = -C(h)
  bool symplectic = true;
  std::string needs = "any H";  // or "separable H"
  std::string source = {};
  Method method = {};

  [[nodiscard]] bool is_member() const { return std::holds_alternative<Member>(method); }
  // The member, or the one that is composed; an internal error for a scheme without.
  [[nodiscard]] const Member& member() const;
  [[nodiscard]] bool has_member() const;
};

// The member with these parameters; each list has one entry, or one per degree of freedom.
// Throws UsageError on a wrong count.
[[nodiscard]] Scheme family_member(int degrees_of_freedom, std::vector<Expression> alpha,
                                   std::vector<Expression> beta, std::vector<Expression> gamma);

// The matrix (1/2 + C) J of zbar = z + h (I/2 + C) J grad H(zbar): nonzero entries.
[[nodiscard]] std::map<std::pair<int, int>, Expression> stage_matrix(const Member& member);

}  // namespace hamgen
