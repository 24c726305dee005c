// A matrix that serves over many steps, in each lane until that wants another one: the factors of
// the other lanes stay as they are.
template <class Matrix>
class KeptMatrix {
 public:
  static constexpr int size = Matrix::size;
  void clear() { fresh_.clear(); }
  void put(int row, int column, const Real& value) { fresh_.put(row, column, value); }
  // False in lanes, of these, whose matrix is singular or not finite.
  Mask factorise(const Mask& lanes) {
    const Mask regular = fresh_.factorise();
    factors_.take(lanes, fresh_);
    return regular | !lanes;
  }
  // In these lanes.
  void solve(const Mask& lanes, Real (&vector)[size]) {
    for (int i = 0; i < size; ++i) solution_[i] = vector[i];
    factors_.solve(solution_);
    for (int i = 0; i < size; ++i) vector[i] = select(lanes, solution_[i], vector[i]);
  }

 private:
  Matrix fresh_, factors_;
  Real solution_[size] = {};
};
