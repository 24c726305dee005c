// x * y less its rounded value, by Dekker's product of halves: exact without a fused multiply-add,
// unless `splitter` times one of them overflows.
inline Real product_error(Real x, Real y) {
  constexpr auto find_splitter = [] {
    Real power = 1;
    while (power * power * epsilon < 2) power *= 2;
    return power + 1;
  };
  constexpr Real splitter = find_splitter();
  const Real large_x = splitter * x;
  const Real large_y = splitter * y;
  const Real x_hi = large_x - (large_x - x);
  const Real y_hi = large_y - (large_y - y);
  const Real x_lo = x - x_hi;
  const Real y_lo = y - y_hi;
  return x_lo * y_lo - (((x * y - x_hi * y_hi) - x_lo * y_hi) - x_hi * y_lo);
}
