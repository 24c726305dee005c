// A matrix with a border of a few full rows and columns, in each lane as for one trajectory
// (bordered_matrix.hpp).
template <class Band, int Count>
class BorderedMatrix : public Border<Band, Count> {
  using Border<Band, Count>::band_, Border<Band, Count>::filled_, Border<Band, Count>::corner_;
  using Border<Band, Count>::column_, Border<Band, Count>::row_;

 public:
  using Border<Band, Count>::size;
  // False in lanes whose matrix is singular or not finite; where its inside is, too, it may be
  // true.
  Mask factorise() {
    filled_ = band_;
    Mask regular = band_.factorise();
    if (!all(regular)) {
      this->shift(filled_);
      const Mask moved = filled_.factorise();
      band_.take(!regular, filled_);
      regular = regular | moved;
    }
    this->take_to_corner();
    return regular & corner_.factorise();
  }
  void solve(Real (&x)[size]) { this->solve_parts(x, within_, beside_); }
  // The factors of another one in these lanes.
  void take(const Mask& lanes, const BorderedMatrix& from) {
    band_.take(lanes, from.band_);
    corner_.take(lanes, from.corner_);
    for (int k = 0; k < Count; ++k) {
      for (int i = 0; i < size - Count; ++i) {
        column_[k][i] = select(lanes, from.column_[k][i], column_[k][i]);
        row_[k][i] = select(lanes, from.row_[k][i], row_[k][i]);
      }
    }
  }

 private:
  Real within_[size - Count] = {};
  Real beside_[Count] = {};
};
