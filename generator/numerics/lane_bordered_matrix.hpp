// A matrix with a border of a few full rows and columns, in each lane as for one trajectory
// (bordered_matrix.hpp).
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
  void put(int row, int column, const Real& value) {
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
  // False in lanes whose matrix is singular or not finite.
  Mask factorise() {
    filled_ = band_;
    Mask regular = band_.factorise();
    if (!all(regular)) {
      for (int i = 0; i < inside; ++i) filled_.put(i, i, Real(find_shift()));
      const Mask moved = filled_.factorise();
      band_.take(!regular, filled_);
      regular = regular | moved;
    }
    for (int k = 0; k < Border; ++k) {
      band_.solve(column_[k]);
      for (int j = 0; j < Border; ++j) corner_.put(j, k, -product(row_[j], column_[k]));
    }
    return regular & corner_.factorise();
  }
  void solve(Real (&x)[size]) {
    for (int i = 0; i < inside; ++i) within_[i] = x[i];
    band_.solve(within_);
    for (int k = 0; k < Border; ++k) beside_[k] = x[inside + k] - product(row_[k], within_);
    corner_.solve(beside_);
    for (int k = 0; k < Border; ++k) {
      for (int i = 0; i < inside; ++i) within_[i] -= column_[k][i] * beside_[k];
    }
    for (int i = 0; i < inside; ++i) x[i] = within_[i];
    for (int k = 0; k < Border; ++k) x[inside + k] = beside_[k];
  }
  // The factors of another one in these lanes.
  void take(const Mask& lanes, const BorderedMatrix& from) {
    band_.take(lanes, from.band_);
    corner_.take(lanes, from.corner_);
    for (int k = 0; k < Border; ++k) {
      for (int i = 0; i < inside; ++i) {
        column_[k][i] = select(lanes, from.column_[k][i], column_[k][i]);
        row_[k][i] = select(lanes, from.row_[k][i], row_[k][i]);
      }
    }
  }

 private:
  // A power of two near the root of a rounding unit.
  static constexpr double find_shift() {
    double power = 1;
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
  Real within_[inside] = {};
  Real beside_[Border] = {};
};
