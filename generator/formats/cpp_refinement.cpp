#include "generator/formats/cpp_refinement.hpp"

#include <fmt/format.h>

namespace hamgen {

long refinement_amplifier(const ScalarType& scalar) { return 1L << (scalar.digits * 3 / 10); }

std::string refinement_remark() {
  return "The unknowns are rounded to the side that the iteration came from, at every step alike. "
         "What "
         "the equations lack there is solved for too.";
}

std::string cpp_refinement(const ScalarType& scalar) {
  return fmt::format(
      R"(// What a fixed point lacks below the last place of its unknowns: the equations are linear over that
// distance, and their change along it is found by a difference over one `amplifier` times as long.
template <int Size, int Components>
struct Refinement {{
  static constexpr Real amplifier = {};
  Real change[Components] = {{}};  // of the gradient, from the rounded point to the solution
  Real slope[Components] = {{}};   // the gradient at the rounded point
  Real at[Size] = {{}};            // that point
  Real missing[Size] = {{}};       // by the equations there
  Real moved[Size] = {{}};         // the solution less the point
  int rounds = 0;

  // lack: the next value less the point.  True if it wants them and the gradient once more, at the
  // point it has moved; else that is the rounded one again.
  bool operator()(Real (&point)[Size], const Real (&lack)[Size],
                  const Real (&gradient)[Components]) {{
    Real size = 0;
    Real last = 0;
    for (int j = 0; j < Size; ++j) {{
      if (rounds == 0) {{
        at[j] = point[j];
        missing[j] = lack[j];
        moved[j] = 0;
      }}
      const Real error = missing[j] + (lack[j] - missing[j]) / amplifier;
      moved[j] += error;
      size += magnitude(moved[j]);
      last += magnitude(error);
    }}
    for (int k = 0; k < Components; ++k) {{
      if (rounds == 0) slope[k] = gradient[k];
      change[k] = (gradient[k] - slope[k]) / amplifier;
    }}
    const bool more = last * 64 > size && rounds < 8;
    rounds = more ? rounds + 1 : 0;
    for (int j = 0; j < Size; ++j) point[j] = more ? at[j] + amplifier * moved[j] : at[j];
    return more;
  }}
}};
)",
      refinement_amplifier(scalar));
}

}  // namespace hamgen
