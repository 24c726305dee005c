// NewtonRuleOfMany of equations whose symmetric matrix it is shown in every step.
//
// Note [what the matrix shows]
// Differences of solutions do not tell what is curved from what swings: the fourth one of
// x'' = -w^2 x is h^4 w^4 x, as if its force bent, and stiff springs took 1.4 iterations where one
// is enough.  By how much the matrix has turned since the step before does.  Row by row and times
// the motion this is a difference of second order, of the force alone: the bend of Note [what its
// own motion shows of each], with what every other unknown does to an equation.  It is that of this
// step or of the last one: where the motion turns round between two steps, the matrix is what it
// was.  (Of a matrix that is not symmetric all of it would have to be kept, which costs a double
// pendulum 4 % and spares it no iteration.)
//
// What moves together turns nothing.  Of a pair that goes a 10th in a step the distance may grow
// from 1e-10, at a saddle; an increment of it leaves bend (increment / move)^2 with the move of the
// distance, and was off by 428 roundings with that of the pair.  So each move counts for as much
// as is left of the sum of all turns in its row, which are those of the distance then.
//
template <int Unknowns>
struct NewtonRuleWithMatrix : NewtonRuleOfMany<2, Unknowns> {
  Real slopes[Unknowns][Unknowns] = {};  // the matrix at the beginning of the step before
  Real ways[Unknowns] = {};              // since that step
  Real turned[Unknowns] = {};            // the bends that it has shown

  // The solution of a step, from the unknown `first` on, before the history records it.
  template <class Past, class Solution>
  void watch(const Past& past, const Solution& solution, int first, int count) {
    this->notice(&solution[first], count);
    for (int j = 0; j < count; ++j) ways[j] = past.way(solution, first + j);
    this->motion = {};
  }
  // The matrix of an iteration, not yet factorised.  In a function of its own, so that what solves
  // remains small enough to be part of the step.
  template <class Matrix>
  __attribute__((noinline)) void compare(const Matrix& matrix, int count) {
    if (this->previous > 0) return;
    Real turns[Unknowns] = {};
    Real sum[Unknowns] = {};  // of these, with their signs
    for (int k = 0; k < count; ++k) {
      for (int j = 0; j < count; ++j) {
        const Real turn = (matrix.at(k, j) - slopes[k][j]) * ways[k];
        turns[j] += magnitude(turn);
        sum[j] += turn;
        slopes[k][j] = matrix.at(k, j);
      }
    }
    Motion seen{0, 0, largest};
    for (int j = 0; j < count; ++j) {
      const Real part = turns[j] > 0 ? magnitude(sum[j]) / turns[j] : Real(1);
      this->moves[j] = magnitude(ways[j]) * part;
      this->bends[j] = turns[j] > turned[j] ? turns[j] : turned[j];
      turned[j] = turns[j];
      const Real move = this->moves[j] * this->unit[j];
      seen.move += move;
      seen.bend += this->bends[j] * this->unit[j];
      seen.least = move < seen.least ? move : seen.least;
    }
    this->motion = seen;
  }
};
