// The quantities in which a series of functions on phase space is written.
//
// For functions S(y) of y = g(z), the displaced point z + w with w = sum over k of h^k w_k,
// w_k = sum over i + l = k of D_l J grad S_i, has
//
//   y_a(z + w) = y_a + grad g_a . w + (1/2) w^T g_a'' w          (g of degree two at most)
//
// so that tables of products of the gradients are all that is needed of z.  The coordinates
// themselves are a chart; in few quadratic forms that H depends on, such as q.q, q.p and p.p of a
// central force, all expressions are far shorter.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/algebra/sparse_matrix.hpp"

namespace hamgen {

struct Chart {
  std::vector<Expression> symbols;  // y_a
  std::vector<Expression> values;   // g_a(z); the symbols themselves for the coordinates
  // By the power l of h:  grad g_a^T D_l J grad g_b,  and  grad g_a^T C_l J grad g_b.
  std::vector<SparseMatrix> displacements;
  std::vector<SparseMatrix> gauges;
  // By powers (l, m) and by a:  (D_l J grad g_b)^T g_a'' (D_m J grad g_c).
  std::map<std::pair<int, int>, std::vector<SparseMatrix>> curvatures;
};

}  // namespace hamgen
