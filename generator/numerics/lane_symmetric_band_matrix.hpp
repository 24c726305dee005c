// A symmetric one: in lanes where it is positive definite L D L^T without pivots, else as any other
// one.
template <int Size, int Width>
class SymmetricBandMatrix : public BandMatrix<Size, Width> {
  using Band = BandMatrix<Size, Width>;

 public:
  static constexpr int size = Size;
  // False in lanes whose matrix is singular or not finite.
  Mask factorise() {
    definite_ = decompose();
    if (all(definite_)) return definite_;
    return definite_ | Band::factorise();
  }
  void solve(Real (&x)[size]) const {
    if (all(definite_)) return substitute(x);
    Real other[size];
    for (int i = 0; i < size; ++i) other[i] = x[i];
    substitute(x);
    Band::solve(other);
    for (int i = 0; i < size; ++i) x[i] = select(definite_, x[i], other[i]);
  }
  // The factors of another one in these lanes.
  void take(const Mask& lanes, const SymmetricBandMatrix& from) {
    definite_ = (lanes & from.definite_) | (!lanes & definite_);
    for (int i = 0; i < size; ++i) {
      reciprocal_[i] = select(lanes, from.reciprocal_[i], reciprocal_[i]);
      for (int k = 0; k < Width; ++k) lower_[i][k] = select(lanes, from.lower_[i][k], lower_[i][k]);
    }
    if (!all(definite_)) Band::take(lanes, from);
  }

 private:
  void substitute(Real (&x)[size]) const {
    for (int r = 1; r < size; ++r) {
      for (int k = Width < r ? Width : r; k > 0; --k) x[r] -= lower_[r - k][k - 1] * x[r - k];
    }
    for (int r = 0; r < size; ++r) x[r] = x[r] * reciprocal_[r];
    for (int r = size - 2; r >= 0; --r) {
      const int below = size - 1 - r;
      for (int k = Width < below ? Width : below; k > 0; --k) x[r] -= lower_[r][k - 1] * x[r + k];
    }
  }
  // Row by row, as of one trajectory; the lanes where it is positive definite.
  Mask decompose() {
    Mask definite = true;
    for (int r = 0; r < size; ++r) {
      Real row[Width + 1];  // of D L^T: columns r to r + Width, those beyond the last are zero
      for (int j = 0; j <= Width; ++j) row[j] = this->at(r, r + j);
      for (int k = Width < r ? Width : r; k > 0; --k) {
        const Real scaled = lower_[r - k][k - 1] * diagonal_[r - k];
        for (int j = 0; j + k <= Width; ++j) row[j] -= scaled * lower_[r - k][k - 1 + j];
      }
      definite = definite & (row[0] > 0);
      if (!any(definite)) break;
      diagonal_[r] = row[0];
      reciprocal_[r] = 1 / row[0];
      for (int j = 1; j <= Width; ++j) lower_[r][j - 1] = row[j] * reciprocal_[r];
    }
    return definite;
  }
  Mask definite_ = false;
  Real lower_[size][Width] = {};  // what stands below the diagonal of a column of L
  Real diagonal_[size] = {};      // D
  Real reciprocal_[size] = {};
};
