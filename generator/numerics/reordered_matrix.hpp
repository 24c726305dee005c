// A matrix for the unknowns in another order: unknown i stands in its row Order::row(i).
template <class Matrix, class Order>
class ReorderedMatrix {
 public:
  static constexpr int size = Matrix::size;
  ReorderedMatrix() {
    for (int i = 0; i < size; ++i) row_[i] = Order::row(i);
  }
  void clear() { matrix_.clear(); }
  void put(int row, int column, Real value) { matrix_.put(row_[row], row_[column], value); }
  // False if the matrix is singular or not finite.
  bool factorise() { return matrix_.factorise(); }
  void solve(Real (&vector)[size]) const {
    Real x[size];
    for (int i = 0; i < size; ++i) x[row_[i]] = vector[i];
    matrix_.solve(x);
    for (int i = 0; i < size; ++i) vector[i] = x[row_[i]];
  }

 private:
  Matrix matrix_;
  int row_[size] = {};
};
