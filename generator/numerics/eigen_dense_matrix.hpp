// A full matrix, eliminated by Eigen; a small one without allocating.
template <int Size>
class EigenDenseMatrix {
 public:
  static constexpr int size = Size;
  void clear() { matrix_.setZero(); }
  void put(int row, int column, Real value) { matrix_(row, column) += value; }
  // False if the matrix is singular or not finite.
  bool factorise() {
    solver_.compute(matrix_);
    const auto pivots = solver_.matrixLU().diagonal().cwiseAbs();
    return pivots.minCoeff() > 0;
  }
  void solve(Real (&vector)[size]) const {
    Eigen::Map<Eigen::Matrix<Real, size, 1>> x(&vector[0]);
    x = solver_.solve(x).eval();
  }

 private:
  static constexpr int extent = size <= 64 ? size : Eigen::Dynamic;
  using Full = Eigen::Matrix<Real, extent, extent>;
  Full matrix_ = Full::Zero(size, size);
  Eigen::PartialPivLU<Full> solver_{size};
};
