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
  const Real& at(int row, int column) const { return entry_[row][column]; }
  // False in lanes whose matrix is singular or not finite.
  Mask factorise() {
    Mask regular = true;
    for (int c = 0; c < size; ++c) {
      // In each lane the largest entry of the column becomes its pivot.
      Real most = magnitude(entry_[c][c]);
      pivot_[c] = c;
      for (int r = c + 1; r < size; ++r) {
        const Mask larger = magnitude(entry_[r][c]) > most;
        most = select(larger, magnitude(entry_[r][c]), most);
        pivot_[c] = select(larger, Real(r), pivot_[c]);
      }
      exchanges_[c] = any(pivot_[c] > c);
      for (int r = c + 1; exchanges_[c] && r < size; ++r) {
        const Mask here = pivot_[c] == r;
        if (!any(here)) continue;
        for (int j = 0; j < size; ++j) exchange(here, entry_[c][j], entry_[r][j]);
      }
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
      for (int r = c + 1; exchanges_[c] && r < size; ++r)
        exchange(pivot_[c] == r, vector[c], vector[r]);
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
      for (int j = 0; j < size; ++j) entry_[i][j] = select(lanes, from.entry_[i][j], entry_[i][j]);
      pivot_[i] = select(lanes, from.pivot_[i], pivot_[i]);
      exchanges_[i] = exchanges_[i] || from.exchanges_[i];
    }
  }

 private:
  static void exchange(const Mask& lanes, Real& a, Real& b) {
    const Real kept = a;
    a = select(lanes, b, a);
    b = select(lanes, kept, b);
  }

  Real entry_[size][size] = {};
  Real pivot_[size] = {};      // its row
  bool exchanges_[size] = {};  // is it another one in some lane?
};
