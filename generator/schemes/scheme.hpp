// A one-step scheme as a plain value.
#pragma once

#include <map>
#include <string>
#include <utility>
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
  int degrees_of_freedom = 0;
  std::map<std::pair<int, int>, Expression> c;  // zero entries are absent
  // How the user said it, one entry per degree of freedom (or one for all of them).
  std::vector<Expression> alpha, beta, gamma;
};

struct Scheme {
  std::string name;         // "implicit-midpoint", or "member" for general parameters
  std::string description;  // "alpha = 1/2, beta = 0, gamma = 0"
  int order = 1;
  bool symmetric = false;   // C(-h) = -C(h)
  std::string source;
  Member member;
};

// The member with these parameters; each list has one entry, or one per degree of freedom.
// Throws UsageError on a wrong count.
[[nodiscard]] Scheme family_member(int degrees_of_freedom, std::vector<Expression> alpha,
                                   std::vector<Expression> beta, std::vector<Expression> gamma);

// The matrix (1/2 + C) J of zbar = z + h (I/2 + C) J grad H(zbar): nonzero entries.
[[nodiscard]] std::map<std::pair<int, int>, Expression> stage_matrix(const Member& member);

}  // namespace hamgen
