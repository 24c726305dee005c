// A matrix in each lane whose entries lie within Width of the diagonal, as for one trajectory
// (band_matrix.hpp), each lane with pivots of its own.
template <int Size, int Width>
class BandMatrix {
 public:
  static constexpr int size = Size;
  void clear() {
    for (auto& row : entry_) {
      for (Real& value : row) value = 0;
    }
  }
  void put(int row, int column, const Real& value) { at(row, column) += value; }
  // False in lanes whose matrix is singular or not finite.
  Mask factorise() {
    Mask regular = true;
    for (int c = 0; c < size; ++c) {
      const int last_row = c + Width < size ? c + Width : size - 1;
      const int last_column = c + 2 * Width < size ? c + 2 * Width : size - 1;
      Mask small = false;
      for (int r = c + 1; r <= last_row; ++r) {
        small = small | (magnitude(at(r, c)) > magnitude(at(c, c)));
      }
      pivots_[c] = any(small);
      for (int r = c + 1; pivots_[c] && r <= last_row; ++r) {
        // In each lane the largest entry of the column becomes its pivot.
        exchanged_[c][r - c - 1] = magnitude(at(r, c)) > magnitude(at(c, c));
        for (int j = c; j <= last_column; ++j)
          exchange(exchanged_[c][r - c - 1], at(c, j), at(r, j));
      }
      regular = regular & (magnitude(at(c, c)) > 0);
      const Real reciprocal = 1 / at(c, c);
      for (int r = c + 1; r <= last_row; ++r) {
        const Real factor = at(r, c) * reciprocal;
        factor_[c][r - c - 1] = factor;
        for (int j = c + 1; j <= last_column; ++j) at(r, j) -= factor * at(c, j);
      }
    }
    return regular;
  }
  void solve(Real (&x)[size]) const {
    for (int c = 0; c < size; ++c) {
      const int last_row = c + Width < size ? c + Width : size - 1;
      for (int r = c + 1; pivots_[c] && r <= last_row; ++r)
        exchange(exchanged_[c][r - c - 1], x[c], x[r]);
      for (int r = c + 1; r <= last_row; ++r) x[r] -= factor_[c][r - c - 1] * x[c];
    }
    for (int r = size - 1; r >= 0; --r) {
      const int last_column = r + 2 * Width < size ? r + 2 * Width : size - 1;
      for (int j = r + 1; j <= last_column; ++j) x[r] -= at(r, j) * x[j];
      x[r] = x[r] / at(r, r);
    }
  }
  // The factors of another one in these lanes.
  void take(const Mask& lanes, const BandMatrix& from) {
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < columns; ++j)
        entry_[i][j] = select(lanes, from.entry_[i][j], entry_[i][j]);
      for (int j = 0; j < Width; ++j) {
        factor_[i][j] = select(lanes, from.factor_[i][j], factor_[i][j]);
        exchanged_[i][j] = (from.exchanges(i, j) & lanes) | (exchanges(i, j) & !lanes);
      }
      pivots_[i] = pivots_[i] || from.pivots_[i];
    }
  }

 private:
  static constexpr int columns = 3 * Width + 1;
  static void exchange(const Mask& lanes, Real& a, Real& b) {
    const Real kept = a;
    a = select(lanes, b, a);
    b = select(lanes, kept, b);
  }
  // Where a column has none they are of an earlier matrix.
  Mask exchanges(int c, int k) const { return pivots_[c] ? exchanged_[c][k] : Mask(false); }
  Real& at(int row, int column) { return entry_[row][column - row + Width]; }
  const Real& at(int row, int column) const { return entry_[row][column - row + Width]; }
  Real entry_[size][columns] = {};
  Real factor_[size][Width] = {};
  Mask exchanged_[size][Width];  // of columns with
  bool pivots_[size] = {};       // exchanges in some lane
};
