// NewtonRuleOfMany, in each lane, of equations whose symmetric matrix it is shown in every step
// (newton_rule_with_matrix.hpp has the reasons).
template <int Unknowns>
struct NewtonRuleWithMatrix : NewtonRuleOfMany<2, Unknowns> {
  using Many = NewtonRuleOfMany<2, Unknowns>;
  Real slopes[Unknowns][Unknowns] = {};
  Real ways[Unknowns] = {};
  Real turned[Unknowns] = {};

  void forget(const Mask& lanes) {
    Many::forget(lanes);
    for (int j = 0; j < Unknowns; ++j) {
      ways[j] = select(lanes, Real(0), ways[j]);
      turned[j] = select(lanes, Real(0), turned[j]);
    }
  }
  template <class Past, int All>
  void watch(const Past& past, const Real (&solution)[All], int first, int count,
             const Mask& lanes = true) {
    this->notice(solution + first, count, lanes);
    for (int j = 0; j < count; ++j) ways[j] = select(lanes, past.way(solution, first + j), ways[j]);
    this->motion = {};
  }
  template <class Matrix>
  void compare(const Matrix& matrix, int count) {
    if (!this->begins) return;
    const Mask& lanes = this->begun;
    Real turns[Unknowns] = {};
    Real sum[Unknowns] = {};
    for (int k = 0; k < count; ++k) {
      for (int j = 0; j < count; ++j) {
        const Real turn = (matrix.at(k, j) - slopes[k][j]) * ways[k];
        turns[j] += magnitude(turn);
        sum[j] += turn;
        slopes[k][j] = select(lanes, matrix.at(k, j), slopes[k][j]);
      }
    }
    Real move = 0;
    Real bend = 0;
    Real slowest = largest;
    for (int j = 0; j < count; ++j) {
      const Real part = select(turns[j] > 0, magnitude(sum[j]) / turns[j], Real(1));
      const Real larger = select(turns[j] > turned[j], turns[j], turned[j]);
      this->moves[j] = select(lanes, magnitude(ways[j]) * part, this->moves[j]);
      this->bends[j] = select(lanes, larger, this->bends[j]);
      turned[j] = select(lanes, turns[j], turned[j]);
      const Real gone = this->moves[j] * this->unit[j];
      move += gone;
      bend += this->bends[j] * this->unit[j];
      slowest = select(gone < slowest, gone, slowest);
    }
    this->motion.move = select(lanes, move, this->motion.move);
    this->motion.bend = select(lanes, bend, this->motion.bend);
    this->motion.least = select(lanes, slowest, this->motion.least);
  }
};
