// A diagonal matrix in each lane.
template <int Size>
class DiagonalMatrix {
 public:
  static constexpr int size = Size;
  void clear() {
    for (Real& value : entry_) value = 0;
  }
  void put(int row, int, const Real& value) { entry_[row] += value; }
  // False in lanes whose matrix is singular or not finite.
  Mask factorise() const {
    Mask regular = true;
    for (const Real& value : entry_) regular = regular & (magnitude(value) > 0);
    return regular;
  }
  void solve(Real (&vector)[size]) const {
    for (int i = 0; i < size; ++i) vector[i] = vector[i] / entry_[i];
  }
  void take(const Mask& lanes, const DiagonalMatrix& from) {
    for (int i = 0; i < size; ++i) entry_[i] = select(lanes, from.entry_[i], entry_[i]);
  }

 private:
  Real entry_[size] = {};
};
