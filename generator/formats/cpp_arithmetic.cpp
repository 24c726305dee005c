#include "generator/formats/cpp_arithmetic.hpp"

namespace hamgen {

void begin_ieee_arithmetic(CodeWriter& out, const ScalarType& scalar) {
  out.lines(
      R"(#if defined __FAST_MATH__ || defined __ASSOCIATIVE_MATH__ || defined __RECIPROCAL_MATH__ || \
    defined __NO_SIGNED_ZEROS__ || (defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__ > 0)
#error "what rounding loses is kept here: compile without -ffast-math, -Ofast and parts of them"
#endif
)");
  if (scalar.digits <= 53) {
    out.lines(
        R"(#if defined __FLT_EVAL_METHOD__ && (__FLT_EVAL_METHOD__ < 0 || __FLT_EVAL_METHOD__ == 2)
#error "numbers must not be kept in wider registers: compile with -msse2 -mfpmath=sse"
#endif
)");
  }
  out.lines(R"(#ifdef __clang__  // which has no macro for -fassociative-math
#pragma float_control(push)
#pragma clang fp reassociate(off)
#endif
)");
}

void end_ieee_arithmetic(CodeWriter& out) {
  out.lines(R"(#ifdef __clang__
#pragma float_control(pop)
#endif
)");
}

}  // namespace hamgen
