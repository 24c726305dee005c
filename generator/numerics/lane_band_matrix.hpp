// The numbers of a band of this width, elimination with partial pivoting fills as many diagonals
// again above it.  Row i holds columns i - width on.
template <int Size, int Width>
class BandStorage {
 protected:
  static constexpr int width() { return Width; }
  void clear_entries() {
    for (auto& row : entry_) {
      for (Real& value : row) value = 0;
    }
  }
  Real& at(int row, int column) { return entry_[row][column - row + Width]; }
  const Real& at(int row, int column) const { return entry_[row][column - row + Width]; }
  Real& factor(int c, int k) { return factor_[c][k]; }
  const Real& factor(int c, int k) const { return factor_[c][k]; }

 private:
  Real entry_[Size][3 * Width + 1] = {};
  Real factor_[Size][Width] = {};
};
// Elimination in a band, in each lane as for one trajectory (band_matrix.hpp), with pivots of its
// own.
template <int Size, class Storage>
class BandElimination : public Storage {
 public:
  static constexpr int size = Size;
  using Storage::at, Storage::factor, Storage::width;
  void clear() { Storage::clear_entries(); }
  void put(int row, int column, const Real& value) { at(row, column) += value; }
  // False in lanes whose matrix is singular or not finite.
  Mask factorise() {
    Mask regular = true;
    for (int c = 0; c < size; ++c) {
      const int last_row = end(c + width());
      const int last_column = end(c + 2 * width());
      // In each lane the largest entry of the column becomes its pivot.
      Real most = magnitude(at(c, c));
      pivot_[c] = c;
      for (int r = c + 1; r <= last_row; ++r) {
        const Mask larger = magnitude(at(r, c)) > most;
        most = select(larger, magnitude(at(r, c)), most);
        pivot_[c] = select(larger, Real(r), pivot_[c]);
      }
      exchanges_[c] = any(pivot_[c] > c);
      for (int r = c + 1; exchanges_[c] && r <= last_row; ++r) {
        const Mask here = pivot_[c] == r;
        if (!any(here)) continue;
        for (int j = c; j <= last_column; ++j) exchange(here, at(c, j), at(r, j));
      }
      regular = regular & (magnitude(at(c, c)) > 0);
      const Real reciprocal = 1 / at(c, c);
      for (int r = c + 1; r <= last_row; ++r) {
        const Real part = at(r, c) * reciprocal;
        factor(c, r - c - 1) = part;
        for (int j = c + 1; j <= last_column; ++j) at(r, j) -= part * at(c, j);
      }
    }
    return regular;
  }
  void solve(Real (&x)[size]) const {
    for (int c = 0; c < size; ++c) {
      const int last_row = end(c + width());
      for (int r = c + 1; exchanges_[c] && r <= last_row; ++r) exchange(pivot_[c] == r, x[c], x[r]);
      for (int r = c + 1; r <= last_row; ++r) x[r] -= factor(c, r - c - 1) * x[c];
    }
    for (int r = size - 1; r >= 0; --r) {
      const int last_column = end(r + 2 * width());
      for (int j = r + 1; j <= last_column; ++j) x[r] -= at(r, j) * x[j];
      x[r] = x[r] / at(r, r);
    }
  }
  // The factors of another one in these lanes.
  void take(const Mask& lanes, const BandElimination& from) {
    for (int i = 0; i < size; ++i) {
      for (int j = i - width(); j <= i + 2 * width(); ++j)
        at(i, j) = select(lanes, from.at(i, j), at(i, j));
      for (int k = 0; k < width(); ++k)
        factor(i, k) = select(lanes, from.factor(i, k), factor(i, k));
      pivot_[i] = select(lanes, from.pivot_[i], pivot_[i]);
      exchanges_[i] = exchanges_[i] || from.exchanges_[i];
    }
  }

 private:
  static int end(int column) { return column < size ? column : size - 1; }
  static void exchange(const Mask& lanes, Real& a, Real& b) {
    const Real kept = a;
    a = select(lanes, b, a);
    b = select(lanes, kept, b);
  }

  Real pivot_[size] = {};      // its row
  bool exchanges_[size] = {};  // is it another one in some lane?
};
template <int Size, int Width>
using BandMatrix = BandElimination<Size, BandStorage<Size, Width>>;
