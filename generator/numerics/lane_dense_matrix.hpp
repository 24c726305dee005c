// A full matrix in each lane: P A = L U by elimination with partial pivoting, each lane with pivots
// of its own, for any number of right sides.
template <int Size>
class DenseMatrix {
 public:
  static constexpr int size = Size;
  void clear() {
    for (auto& row : entry_) {
      for (Real& value : row) value = 0;
    }
  }
  void put(int row, int column, const Real& value) { entry_[row][column] += value; }
  // False in lanes whose matrix is singular or not finite.
  Mask factorise() {
    Mask regular = true;
    for (int c = 0; c < size; ++c) {
      Mask small = false;
      for (int r = c + 1; r < size; ++r) {
        small = small | (magnitude(entry_[r][c]) > magnitude(entry_[c][c]));
      }
      pivots_[c] = any(small);
      if (pivots_[c]) bring_largest(c);
      regular = regular & (magnitude(entry_[c][c]) > 0);
      const Real reciprocal = 1 / entry_[c][c];
      for (int r = c + 1; r < size; ++r) {
        const Real factor = entry_[r][c] * reciprocal;
        entry_[r][c] = factor;
        for (int j = c + 1; j < size; ++j) entry_[r][j] -= factor * entry_[c][j];
      }
    }
    return regular;
  }
  void solve(Real (&vector)[size]) const {
    for (int c = 0; c < size; ++c) {
      for (int r = c + 1; pivots_[c] && r < size; ++r) {
        exchange(exchanged_[c][r], vector[c], vector[r]);
      }
    }
    for (int r = 0; r < size; ++r) {
      for (int j = 0; j < r; ++j) vector[r] -= entry_[r][j] * vector[j];
    }
    for (int r = size - 1; r >= 0; --r) {
      for (int j = r + 1; j < size; ++j) vector[r] -= entry_[r][j] * vector[j];
      vector[r] = vector[r] / entry_[r][r];
    }
  }
  // The factors of another one in these lanes.
  void take(const Mask& lanes, const DenseMatrix& from) {
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) {
        entry_[i][j] = select(lanes, from.entry_[i][j], entry_[i][j]);
        exchanged_[i][j] = (from.exchanges(i, j) & lanes) | (exchanges(i, j) & !lanes);
      }
      pivots_[i] = pivots_[i] || from.pivots_[i];
    }
  }

 private:
  // In each lane the largest entry of the column becomes its pivot.
  void bring_largest(int c) {
    for (int r = c + 1; r < size; ++r) {
      exchanged_[c][r] = magnitude(entry_[r][c]) > magnitude(entry_[c][c]);
      for (int j = 0; j < size; ++j) exchange(exchanged_[c][r], entry_[c][j], entry_[r][j]);
    }
  }
  // Where a column has none they are of an earlier matrix.
  Mask exchanges(int c, int r) const { return pivots_[c] ? exchanged_[c][r] : Mask(false); }
  static void exchange(const Mask& lanes, Real& a, Real& b) {
    const Real kept = a;
    a = select(lanes, b, a);
    b = select(lanes, kept, b);
  }

  Real entry_[size][size] = {};
  Mask exchanged_[size][size];  // of columns with
  bool pivots_[size] = {};      // exchanges in some lane
};
