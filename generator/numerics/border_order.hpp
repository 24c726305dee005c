// The order of unknowns some of which, in ascending order here, stand behind all others: these are
// `inside` many, ordered by ElementOrder.
template <int inside, int arrays, int length, bool folded, int... border>
struct BorderOrder {
  static int row(int i) {
    int before = 0;
    int place = inside;
    constexpr int unknowns[] = {border...};
    for (const int unknown : unknowns) {
      if (unknown == i) return place;
      before += unknown < i;
      ++place;
    }
    return ElementOrder<arrays, length, folded>::row(i - before);
  }
};
