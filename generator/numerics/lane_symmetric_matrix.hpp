// A symmetric matrix in each lane, of which the diagonal and what is below are given.
template <int Size>
class SymmetricMatrix : public DenseMatrix<Size> {
 public:
  void put(int row, int column, const Real& value) {
    DenseMatrix<Size>::put(row, column, value);
    if (row != column) DenseMatrix<Size>::put(column, row, value);
  }
};
