// x - y less its rounded value (Knuth): exact whatever their sizes.
inline Real difference_error(const Real& x, const Real& y) {
  const Real difference = x - y;
  const Real part = x - difference;
  return (x - (difference + part)) + (part - y);
}
