// A symmetric matrix, of which the diagonal and what is below are given: L D L^T without pivots
// where it is positive definite, else as any other one.
template <int Size>
class SymmetricMatrix : public DenseMatrix<Size> {
 public:
  static constexpr int size = Size;
  void put(int row, int column, Real value) {
    this->entry_[row][column] += value;
    this->entry_[column][row] = this->entry_[row][column];
  }
  // False if the matrix is singular or not finite.
  bool factorise() {
    is_definite_ = decompose();
    return is_definite_ || DenseMatrix<Size>::factorise();
  }
  void solve(Real (&vector)[size]) const {
    if (!is_definite_) return DenseMatrix<Size>::solve(vector);
    for (int r = 0; r < size; ++r) {
      for (int j = 0; j < r; ++j) vector[r] -= lower_[r][j] * vector[j];
    }
    for (int r = size - 1; r >= 0; --r) {
      vector[r] *= reciprocal_[r];
      for (int j = r + 1; j < size; ++j) vector[r] -= lower_[j][r] * vector[j];
    }
  }

 private:
  // Row by row; false where it is not positive definite.
  bool decompose() {
    Real scaled[size];  // a row of L D
    for (int r = 0; r < size; ++r) {
      Real diagonal = this->entry_[r][r];
      for (int c = 0; c < r; ++c) {
        scaled[c] = this->entry_[r][c];
        for (int j = 0; j < c; ++j) scaled[c] -= scaled[j] * lower_[c][j];
        lower_[r][c] = scaled[c] * reciprocal_[c];
        diagonal -= scaled[c] * lower_[r][c];
      }
      if (!(diagonal > 0)) return false;
      reciprocal_[r] = 1 / diagonal;
    }
    return true;
  }
  bool is_definite_ = false;
  Real lower_[size][size];
  Real reciprocal_[size];
};
