// The elementary functions on lanes for three sets of instructions, and what they are measured
// against.
#pragma once

#include <quadmath.h>

#include <cmath>
#include <string>
#include <vector>

namespace hamgen::numerics_blocks_test {

// values[i] = f(x[i], y[i]) in packs of 1, 2, 4 or 8 lanes; `count` is a multiple of it.
using Evaluate = void(int function, int lanes, const double* x, const double* y, double* values,
                      int count);
namespace of_portable {
Evaluate evaluate;
}
namespace of_avx2 {
Evaluate evaluate;
}
namespace of_avx512 {
Evaluate evaluate;
}

__extension__ typedef __float128 Quad;

struct LaneFunction {
  const char* name;
  double (*library)(double x, double y);
  Quad (*quad)(Quad x, Quad y);
};

#define HAMGEN_OF_ONE(function)                                                                   \
  LaneFunction {                                                                                  \
#function,                                                                                    \
        [](double x,                                                                              \
           double) { return std::function(x); },                                                  \
                                              [](Quad x, Quad) -> Quad { return function##q(x); } \
  }
#define HAMGEN_OF_TWO(function)                                                                  \
  LaneFunction {                                                                                 \
#function,                                                                                   \
        [](double x,                                                                             \
           double y) { return std::function(x, y); }, [](Quad x, Quad y)                         \
                                                           -> Quad { return function##q(x, y); } \
  }
inline const LaneFunction kLaneFunctions[] = {
    HAMGEN_OF_ONE(fabs),  HAMGEN_OF_ONE(acos), HAMGEN_OF_ONE(acosh), HAMGEN_OF_ONE(asin),
    HAMGEN_OF_ONE(asinh), HAMGEN_OF_ONE(atan), HAMGEN_OF_TWO(atan2), HAMGEN_OF_ONE(atanh),
    HAMGEN_OF_ONE(cos),   HAMGEN_OF_ONE(cosh), HAMGEN_OF_ONE(exp),   HAMGEN_OF_ONE(log),
    HAMGEN_OF_TWO(pow),   HAMGEN_OF_ONE(sin),  HAMGEN_OF_ONE(sinh),  HAMGEN_OF_ONE(sqrt),
    HAMGEN_OF_ONE(tan),   HAMGEN_OF_ONE(tanh),
};
#undef HAMGEN_OF_ONE
#undef HAMGEN_OF_TWO

}  // namespace hamgen::numerics_blocks_test
