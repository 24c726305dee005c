// Any member of the family at any order: what stands in for H in its step.
//
// The generating function of the exact flow, cut off after h^r, gives a symplectic step of order r
// that is solved once: Z = z + h J grad K(zbar, h), zbar = (z + Z)/2 + C (Z - z).
#pragma once

#include <string>
#include <vector>

#include "generator/mechanics/generating_series.hpp"

namespace hamgen {

struct GeneratingFunction {
  int order = 0;
  std::vector<Expression> gradient;  // of K by z, 2n, in z, h and the parameters
  // Of a system whose sums are kept: K as sums, and no expressions written out.
  std::vector<Kernel> kernels = {};
  // Second derivatives, i <= j: of the K of `hessian_order`, which is lower where that saves more
  // than Newton's iteration loses by it.
  SparseMatrix hessian;
  int hessian_order = 0;
  std::string form;     // how K is written, for people
  long operations = 0;  // of gradient and Hessian together; a function counts 10
};

enum class HessianWish { cheapest, exact };

// The shortest of the forms K can be given.  Its Hessian is its own where that is wished for, and
// short enough.  Throws UsageError, with the alternatives, where that
// is too long to be compiled in reasonable time.
[[nodiscard]] GeneratingFunction generating_function(const Mechanics& mechanics,
                                                     const SparseMatrix& c, int order,
                                                     HessianWish wish = HessianWish::cheapest);

[[nodiscard]] std::string to_text(const GeneratingFunction& function);

}  // namespace hamgen
