// A matrix of which a few rows and columns, behind all others, are full: a border around what Band
// stands for.  That is eliminated first, with its own pivots, then the corner, less what the border
// takes to it.
template <class Band, int Count>
class BorderedMatrix : public Border<Band, Count> {
  using Border<Band, Count>::band_, Border<Band, Count>::filled_, Border<Band, Count>::corner_;

 public:
  using Border<Band, Count>::size;
  // False if the matrix is singular or not finite; where its inside is, too, it may be true.
  bool factorise() {
    filled_ = band_;
    if (!band_.factorise()) {
      band_ = filled_;
      this->shift(band_);
      if (!band_.factorise()) return false;
    }
    this->take_to_corner();
    return corner_.factorise();
  }
  void solve(Real (&x)[size]) const {
    Real within[size - Count];
    Real beside[Count];
    this->solve_parts(x, within, beside);
  }
};
