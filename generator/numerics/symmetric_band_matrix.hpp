// A symmetric one: L D L^T without pivots where it is positive definite, else as any other one.
template <int Size, int Width>
class SymmetricBandMatrix : public BandMatrix<Size, Width> {
  using Band = BandMatrix<Size, Width>;
  using Band::entry_, Band::factor_;

 public:
  static constexpr int size = Size;
  // False if the matrix is singular or not finite.
  bool factorise() {
    is_definite_ = decompose();
    return is_definite_ || Band::factorise();
  }
  void solve(Real (&x)[size]) const {
    if (!is_definite_) return Band::solve(x);
    for (int r = 0; r < size && r < Width; ++r) x[r] = less_those_above(x, r, r);
    for (int r = Width; r < size; ++r) x[r] = less_those_above(x, r, Width);
    for (int r = 0; r < size; ++r) x[r] *= reciprocal_[r];
    int r = size - 1;
    for (; r >= 0 && r > size - 1 - Width; --r) x[r] = less_those_below(x, r, size - 1 - r);
    for (; r >= 0; --r) x[r] = less_those_below(x, r, Width);
  }

 private:
  // The nearest comes last: it is the one that is waited for.
  Real less_those_above(const Real (&x)[size], int r, int count) const {
    Real value = x[r];
    for (int k = count; k > 0; --k) value -= factor_[r - k][k - 1] * x[r - k];
    return value;
  }
  Real less_those_below(const Real (&x)[size], int r, int count) const {
    Real value = x[r];
    for (int k = count; k > 0; --k) value -= factor_[r][k - 1] * x[r + k];
    return value;
  }
  // False where the matrix is not positive definite.
  bool decompose() {
    for (int r = 0; r < size && r < Width; ++r) {
      if (!eliminate(r, r)) return false;
    }
    for (int r = Width; r < size; ++r) {
      if (!eliminate(r, Width)) return false;
    }
    return true;
  }
  bool eliminate(int r, int rows_above) {
    Real row[Width + 1];  // of D L^T: columns r to r + Width, those beyond the last are zero
    for (int j = 0; j <= Width; ++j) row[j] = entry_[r][Width + j];
    for (int k = rows_above; k > 0; --k) {
      const Real scaled = factor_[r - k][k - 1] * diagonal_[r - k];
      for (int j = 0; j + k <= Width; ++j) row[j] -= scaled * factor_[r - k][k - 1 + j];
    }
    if (!(row[0] > 0)) return false;
    diagonal_[r] = row[0];
    reciprocal_[r] = 1 / row[0];
    for (int j = 1; j <= Width; ++j) factor_[r][j - 1] = row[j] * reciprocal_[r];
    return true;
  }
  bool is_definite_ = false;
  Real diagonal_[size] = {};    // D
  Real reciprocal_[size] = {};  // of it
};
