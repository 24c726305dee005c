// The inverse of a matrix in each lane that is wanted many times; false where it is singular.
template <class Matrix, int Size>
inline Mask invert(Matrix& matrix, Real (&inverse)[Size][Size]) {
  const Mask regular = matrix.factorise();
  for (int c = 0; c < Size; ++c) {
    Real column[Size] = {};
    column[c] = 1;
    matrix.solve(column);
    for (int i = 0; i < Size; ++i) inverse[i][c] = column[i];
  }
  return regular;
}
