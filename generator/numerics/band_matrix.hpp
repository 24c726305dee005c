// A matrix whose entries lie within Width of the diagonal.  Elimination with partial pivoting fills
// as many diagonals again above it.  Row i holds columns i - Width on.
template <int Size, int Width>
class BandMatrix {
 public:
  static constexpr int size = Size;
  void clear() {
    for (auto& row : entry_) {
      for (Real& value : row) value = 0;
    }
  }
  void put(int row, int column, Real value) { at(row, column) += value; }
  // False if the matrix is singular or not finite.
  bool factorise() {
    for (int c = 0; c < size; ++c) {
      const int last_row = c + Width < size ? c + Width : size - 1;
      const int last_column = c + 2 * Width < size ? c + 2 * Width : size - 1;
      int pivot = c;
      for (int r = c + 1; r <= last_row; ++r) {
        if (magnitude(at(r, c)) > magnitude(at(pivot, c))) pivot = r;
      }
      if (!(magnitude(at(pivot, c)) > 0)) return false;
      pivot_[c] = pivot;
      if (pivot != c) {
        for (int j = c; j <= last_column; ++j) {
          const Real kept = at(c, j);
          at(c, j) = at(pivot, j);
          at(pivot, j) = kept;
        }
      }
      const Real reciprocal = 1 / at(c, c);
      for (int r = c + 1; r <= last_row; ++r) {
        const Real factor = at(r, c) * reciprocal;
        factor_[c][r - c - 1] = factor;
        for (int j = c + 1; j <= last_column; ++j) at(r, j) -= factor * at(c, j);
      }
    }
    return true;
  }
  void solve(Real (&x)[size]) const {
    for (int c = 0; c < size; ++c) {
      const Real kept = x[c];
      x[c] = x[pivot_[c]];
      if (pivot_[c] != c) x[pivot_[c]] = kept;
      const int last_row = c + Width < size ? c + Width : size - 1;
      for (int r = c + 1; r <= last_row; ++r) x[r] -= factor_[c][r - c - 1] * x[c];
    }
    for (int r = size - 1; r >= 0; --r) {
      const int last_column = r + 2 * Width < size ? r + 2 * Width : size - 1;
      for (int j = r + 1; j <= last_column; ++j) x[r] -= at(r, j) * x[j];
      x[r] /= at(r, r);
    }
  }

 protected:
  static constexpr int columns = 3 * Width + 1;
  Real& at(int row, int column) { return entry_[row][column - row + Width]; }
  const Real& at(int row, int column) const { return entry_[row][column - row + Width]; }
  Real entry_[size][columns] = {};
  Real factor_[size][Width] = {};
  int pivot_[size] = {};
};
