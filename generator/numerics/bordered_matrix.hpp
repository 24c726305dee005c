// A matrix of which a few rows and columns, behind all others, are full: a border around what Band
// stands for.  That is eliminated first, with its own pivots, then the corner, less what the border
// takes to it.
//
// Note [what only the border holds]
// What is inside may be singular where all of it is not, as 1 + h^2/4 V'' of an element whose force
// grows, at one step size.  Then its diagonal is moved by the root of a rounding unit: that much
// the matrix is off, and as much rounding makes of what is eliminated by so small a pivot.  An
// iteration comes to its end by either.
//
template <class Band, int Border>
class BorderedMatrix {
 public:
  static constexpr int inside = Band::size;
  static constexpr int size = inside + Border;
  void clear() {
    band_.clear();
    corner_.clear();
    for (int k = 0; k < Border; ++k) {
      for (int i = 0; i < inside; ++i) column_[k][i] = row_[k][i] = 0;
    }
  }
  void put(int row, int column, Real value) {
    if (row < inside && column < inside) {
      band_.put(row, column, value);
    } else if (row < inside) {
      column_[column - inside][row] += value;
    } else if (column < inside) {
      row_[row - inside][column] += value;
    } else {
      corner_.put(row - inside, column - inside, value);
    }
  }
  // False if the matrix is singular or not finite; where its inside is, too, it may be true.
  bool factorise() {
    filled_ = band_;
    if (!band_.factorise()) {
      band_ = filled_;
      for (int i = 0; i < inside; ++i) band_.put(i, i, find_shift());
      if (!band_.factorise()) return false;
    }
    for (int k = 0; k < Border; ++k) {
      band_.solve(column_[k]);
      for (int j = 0; j < Border; ++j) corner_.put(j, k, -product(row_[j], column_[k]));
    }
    return corner_.factorise();
  }
  void solve(Real (&x)[size]) const {
    Real within[inside];
    Real beside[Border];
    for (int i = 0; i < inside; ++i) within[i] = x[i];
    band_.solve(within);
    for (int k = 0; k < Border; ++k) beside[k] = x[inside + k] - product(row_[k], within);
    corner_.solve(beside);
    for (int k = 0; k < Border; ++k) {
      for (int i = 0; i < inside; ++i) within[i] -= column_[k][i] * beside[k];
    }
    for (int i = 0; i < inside; ++i) x[i] = within[i];
    for (int k = 0; k < Border; ++k) x[inside + k] = beside[k];
  }

 private:
  // A power of two near the root of a rounding unit.
  static constexpr Real find_shift() {
    Real power = 1;
    while (power * power > epsilon) power /= 2;
    return power;
  }
  static Real product(const Real (&a)[inside], const Real (&b)[inside]) {
    Real sum = 0;
    for (int i = 0; i < inside; ++i) sum += a[i] * b[i];
    return sum;
  }

  Band band_, filled_;
  DenseMatrix<Border> corner_;
  Real column_[Border][inside] = {};  // of the border, then by what they move the inside
  Real row_[Border][inside] = {};
};
