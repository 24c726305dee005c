// A matrix for the unknowns in another order: unknown i stands in its row Order::row(i).
template <class Matrix, class Order>
class ReorderedMatrix {
 public:
  static constexpr int size = Matrix::size;
  ReorderedMatrix() {
    for (int i = 0; i < size; ++i) row_[i] = Order::row(i);
  }
  void clear() { matrix_.clear(); }
  void put(int row, int column, const Real& value) { matrix_.put(row_[row], row_[column], value); }
  // False in lanes whose matrix is singular or not finite.
  Mask factorise() { return matrix_.factorise(); }
  void solve(Real (&vector)[size]) {
    for (int i = 0; i < size; ++i) reordered_[row_[i]] = vector[i];
    matrix_.solve(reordered_);
    for (int i = 0; i < size; ++i) vector[i] = reordered_[row_[i]];
  }
  void take(const Mask& lanes, const ReorderedMatrix& from) { matrix_.take(lanes, from.matrix_); }

 private:
  Matrix matrix_;
  int row_[size] = {};
  Real reordered_[size] = {};
};
