// NewtonRuleOfMany of equations whose symmetric matrix it is shown in every step.
//
// Note [what the matrix shows]
// Differences of solutions do not tell what is curved from what swings: the fourth one of
// x'' = -w^2 x is h^4 w^4 x, as if its force bent, and stiff springs took 1.3 iterations where one
// is enough.  By how much the matrix has turned since the step before does.  Row by row and times
// the motion this is a difference of second order, of the force alone: the bend of Note [what its
// own motion shows of each], of this step and not of the last one, and with what every other
// unknown does to an equation.  (Of a matrix that is not symmetric all of it would have to be kept,
// which costs a double pendulum 4 % and spares it no iteration.)
//
template <int Unknowns>
struct NewtonRuleWithMatrix : NewtonRuleOfMany<2, Unknowns> {
  Real slopes[Unknowns][Unknowns] =
      {};  // the lower half, in the first iteration of the step before

  // The solution of a step, from the unknown `first` on, before the history records it.
  template <class Past, class Solution>
  void watch(const Past& past, const Solution& solution, int first, int count) {
    if (++this->age >= 16) this->follow(&solution[first], count);
    Real move = 0;
    Real slowest = largest;
    for (int j = 0; j < count; ++j) {
      this->moves[j] = past.difference(0, solution, first + j);
      const Real part = this->moves[j] * this->unit[j];
      move += part;
      slowest = part < slowest ? part : slowest;
    }
    this->motion = {move, 0, slowest};
  }
  // The matrix of an iteration, not yet factorised.
  template <class Matrix>
  void compare(const Matrix& matrix, int count) {
    if (this->previous > 0) return;
    for (int j = 0; j < count; ++j) this->bends[j] = 0;
    for (int r = 0; r < count; ++r) {
      for (int c = 0; c <= r; ++c) {
        const Real turn = magnitude(matrix.at(r, c) - slopes[r][c]);
        this->bends[c] += turn * this->moves[r];
        if (c < r) this->bends[r] += turn * this->moves[c];
        slopes[r][c] = matrix.at(r, c);
      }
    }
    this->motion.bend = 0;
    for (int j = 0; j < count; ++j) this->motion.bend += this->bends[j] * this->unit[j];
  }
};
