// A sparse matrix that is filled again and again by the same sequence of entries.  The first
// filling finds the pattern, later ones only add values in place.
template <int Size>
class EigenSparseMatrix {
 public:
  static constexpr int size = Size;
  void clear() {
    next_ = 0;
    if (known_) std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), Real(0));
  }
  void put(int row, int column, Real value) {
    if (known_) {
      matrix_.valuePtr()[place_[next_++]] += value;
    } else {
      entries_.emplace_back(row, column, value);
    }
  }
  // False if the matrix is singular or not finite.
  bool factorise() {
    if (!known_) find_pattern();
    solver_.factorize(matrix_);
    return solver_.info() == Eigen::Success;
  }
  void solve(Real (&vector)[size]) {
    Eigen::Map<Eigen::Matrix<Real, Eigen::Dynamic, 1>> x(&vector[0], size);
    x = solver_.solve(x).eval();
  }

 private:
  void find_pattern() {
    matrix_.setFromTriplets(entries_.begin(), entries_.end());
    matrix_.makeCompressed();
    for (const Eigen::Triplet<Real>& entry : entries_) {
      const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[entry.col()];
      const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[entry.col() + 1];
      const int* found = std::lower_bound(begin, end, entry.row());
      place_.push_back(static_cast<std::size_t>(found - matrix_.innerIndexPtr()));
    }
    solver_.analyzePattern(matrix_);
    entries_.clear();
    known_ = true;
  }
  bool known_ = false;
  std::size_t next_ = 0;
  std::vector<Eigen::Triplet<Real>> entries_;
  std::vector<std::size_t> place_;
  Eigen::SparseMatrix<Real> matrix_{size, size};
  Eigen::SparseLU<Eigen::SparseMatrix<Real>> solver_;
};
