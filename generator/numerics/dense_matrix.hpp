// A full matrix: P A = L U by elimination with partial pivoting, for any number of right sides.
template <int Size>
class DenseMatrix {
 public:
  static constexpr int size = Size;
  void clear() {
    for (auto& row : entry_) {
      for (Real& value : row) value = 0;
    }
  }
  void put(int row, int column, Real value) { entry_[row][column] += value; }
  Real at(int row, int column) const { return entry_[row][column]; }
  // False if the matrix is singular or not finite.
  bool factorise() {
    for (int c = 0; c < size; ++c) {
      int pivot = c;
      for (int r = c + 1; r < size; ++r) {
        if (magnitude(entry_[r][c]) > magnitude(entry_[pivot][c])) pivot = r;
      }
      if (!(magnitude(entry_[pivot][c]) > 0)) return false;
      pivot_[c] = pivot;
      for (int j = 0; pivot != c && j < size; ++j) {
        const Real kept = entry_[c][j];
        entry_[c][j] = entry_[pivot][j];
        entry_[pivot][j] = kept;
      }
      const Real reciprocal = 1 / entry_[c][c];
      for (int r = c + 1; r < size; ++r) {
        const Real factor = entry_[r][c] * reciprocal;
        entry_[r][c] = factor;
        for (int j = c + 1; j < size; ++j) entry_[r][j] -= factor * entry_[c][j];
      }
    }
    return true;
  }
  void solve(Real (&vector)[size]) const {
    for (int c = 0; c < size; ++c) {
      const Real kept = vector[c];
      vector[c] = vector[pivot_[c]];
      if (pivot_[c] != c) vector[pivot_[c]] = kept;
    }
    for (int r = 0; r < size; ++r) {
      for (int j = 0; j < r; ++j) vector[r] -= entry_[r][j] * vector[j];
    }
    for (int r = size - 1; r >= 0; --r) {
      for (int j = r + 1; j < size; ++j) vector[r] -= entry_[r][j] * vector[j];
      vector[r] /= entry_[r][r];
    }
  }

 protected:
  Real entry_[size][size] = {};
  int pivot_[size] = {};
};
