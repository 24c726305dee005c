// What a BorderedMatrix is made of: what is inside, as Band has it, the corner, and between them
// the rows and columns of the border, which stands behind all others.
//
// Note [what only the border holds]
// What is inside may be singular where all of it is not, as 1 + h^2/4 V'' of an element whose force
// grows, at one step size.  Then its diagonal is moved by the root of a rounding unit: that much
// the matrix is off, and as much rounding makes of what is eliminated by so small a pivot.  An
// iteration comes to its end by either.
//
template <class Band, int Count>
class Border {
 public:
  static constexpr int inside = Band::size;
  static constexpr int size = inside + Count;
  void clear() {
    band_.clear();
    corner_.clear();
    for (int k = 0; k < Count; ++k) {
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

 protected:
  // A power of two near the root of a rounding unit.
  static constexpr auto find_shift() {
    auto power = epsilon;
    while (power * power < epsilon) power *= 2;
    return power;
  }
  static void shift(Band& singular) {
    for (int i = 0; i < inside; ++i) singular.put(i, i, find_shift());
  }
  // Takes the border to the corner, once the band is eliminated.
  void take_to_corner() {
    for (int k = 0; k < Count; ++k) {
      band_.solve(column_[k]);
      for (int j = 0; j < Count; ++j) corner_.put(j, k, -product(row_[j], column_[k]));
    }
  }
  // In turn by the band, the corner and the border's columns; within and beside are its parts.
  void solve_parts(Real (&x)[size], Real (&within)[inside], Real (&beside)[Count]) const {
    for (int i = 0; i < inside; ++i) within[i] = x[i];
    band_.solve(within);
    for (int k = 0; k < Count; ++k) beside[k] = x[inside + k] - product(row_[k], within);
    corner_.solve(beside);
    for (int k = 0; k < Count; ++k) {
      for (int i = 0; i < inside; ++i) within[i] -= column_[k][i] * beside[k];
    }
    for (int i = 0; i < inside; ++i) x[i] = within[i];
    for (int k = 0; k < Count; ++k) x[inside + k] = beside[k];
  }
  static Real product(const Real (&a)[inside], const Real (&b)[inside]) {
    Real sum = 0;
    for (int i = 0; i < inside; ++i) sum += a[i] * b[i];
    return sum;
  }

  Band band_, filled_;
  DenseMatrix<Count> corner_;
  Real column_[Count][inside] = {};  // then by what they move the inside
  Real row_[Count][inside] = {};
};
