// What a fixed point lacks below the last place of its unknowns.  A rounded iteration ends at one
// of two neighbours, on the side that it came from, and that is the same step after step: a bias,
// and no chance.  What the equations lack there is small, and known without an error.  Over that
// distance they are linear; their change along it is found by a difference over one `amplifier`
// times as long: what is not linear, and what a difference loses, are both far below a unit of
// rounding.
template <int Size, int Components>
struct Refinement {
  // A power of two near the third root of 1/epsilon.
  static constexpr Real find_amplifier() {
    Real power = 1;
    while (power * power * power * (8 * epsilon) < 1) power *= 2;
    return power;
  }
  static constexpr Real amplifier = find_amplifier();
  Real change[Components] = {};  // of the gradient, from the rounded point to the solution
  Real slope[Components] = {};   // the gradient at the rounded point
  Real at[Size] = {};            // that point
  Real missing[Size] = {};       // by the equations there
  Real moved[Size] = {};         // the solution less the point
  int rounds = 0;

  // lack: the next value less the point, or that multiplied by a matrix that contracts better. True
  // if it wants these and the gradient once more, at the point it has moved; else that is the
  // rounded one again.
  bool operator()(Real (&point)[Size], const Real (&lack)[Size],
                  const Real (&gradient)[Components]) {
    Real size = 0;
    Real last = 0;
    for (int j = 0; j < Size; ++j) {
      if (rounds == 0) {
        at[j] = point[j];
        missing[j] = lack[j];
        moved[j] = 0;
      }
      const Real error = missing[j] + (lack[j] - missing[j]) / amplifier;
      moved[j] += error;
      size += magnitude(moved[j]);
      last += magnitude(error);
    }
    for (int k = 0; k < Components; ++k) {
      if (rounds == 0) slope[k] = gradient[k];
      change[k] = (gradient[k] - slope[k]) / amplifier;
    }
    const bool more = last * 64 > size && rounds < 8;
    rounds = more ? rounds + 1 : 0;
    for (int j = 0; j < Size; ++j) point[j] = more ? at[j] + amplifier * moved[j] : at[j];
    return more;
  }
};
