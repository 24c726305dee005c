// NewtonRuleOfMany, in each lane, of equations whose symmetric matrix it is shown in every step
// (newton_rule_with_matrix.hpp has the reasons).
template <int Unknowns>
struct NewtonRuleWithMatrix : NewtonRuleOfMany<2, Unknowns> {
  Real slopes[Unknowns][Unknowns] = {};

  template <class Past, int All>
  void watch(const Past& past, const Real (&solution)[All], int first, int count,
             const Mask& lanes = true) {
    this->age = (this->age + 1) % 16;
    Real move = 0;
    if (any(lanes)) {
      if (this->age == 0) this->follow(solution + first, count, lanes);
      for (int j = 0; j < count; ++j) {
        Real& moves = this->moves[j];
        moves = select(lanes, past.template difference<0>(solution, first + j), moves);
        move += moves * this->unit[j];
      }
    }
    this->motion.move = select(lanes, move, Real(0));
    this->motion.bend = 0;
  }
  template <class Matrix>
  void compare(const Matrix& matrix, int count) {
    if (!this->begins) return;
    const Mask& lanes = this->begun;
    Real turned[Unknowns] = {};
    for (int r = 0; r < count; ++r) {
      for (int c = 0; c <= r; ++c) {
        const Real turn = magnitude(matrix.at(r, c) - slopes[r][c]);
        turned[c] += turn * this->moves[r];
        if (c < r) turned[r] += turn * this->moves[c];
        slopes[r][c] = select(lanes, matrix.at(r, c), slopes[r][c]);
      }
    }
    Real bend = 0;
    for (int j = 0; j < count; ++j) {
      this->bends[j] = select(lanes, turned[j], this->bends[j]);
      bend += turned[j] * this->unit[j];
    }
    this->motion.bend = select(lanes, bend, this->motion.bend);
  }
};
