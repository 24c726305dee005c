// The order of unknowns that stand in arrays of one length, element by element.  Those of a ring
// are folded flat: first, last, second, last but one, ...  What is behind the arrays stays there.
template <int arrays, int length, bool folded>
struct ElementOrder {
  static int row(int i) {
    if (i >= arrays * length) return i;
    const int k = i % length;
    const int element = !folded ? k : 2 * k < length ? 2 * k : 2 * (length - 1 - k) + 1;
    return arrays * element + i / length;
  }
};
