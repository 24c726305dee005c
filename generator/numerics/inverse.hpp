// The inverse of a matrix that is wanted many times; false if singular.
template <class Matrix, int Size>
inline bool invert(Matrix& matrix, Real (&inverse)[Size][Size]) {
  if (!matrix.factorise()) return false;
  for (int c = 0; c < Size; ++c) {
    Real column[Size] = {};
    column[c] = 1;
    matrix.solve(column);
    for (int i = 0; i < Size; ++i) inverse[i][c] = column[i];
  }
  return true;
}
