// A diagonal matrix.
template <int Size>
class DiagonalMatrix {
 public:
  static constexpr int size = Size;
  void clear() {
    for (Real& value : entry_) value = 0;
  }
  void put(int row, int, Real value) { entry_[row] += value; }
  // False if the matrix is singular or not finite.
  bool factorise() const {
    for (const Real value : entry_) {
      if (!(magnitude(value) > 0)) return false;
    }
    return true;
  }
  void solve(Real (&vector)[size]) const {
    for (int i = 0; i < size; ++i) vector[i] /= entry_[i];
  }

 private:
  Real entry_[size] = {};
};
