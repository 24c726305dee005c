// What Distance adds of arrays, in the same eight parts, and so with the same bits.
template <int W>
inline double total_of(const Pack<W> (&parts)[8 / W]) {
  double x[8];
  for (int k = 0; k < 8 / W; ++k) Pack<W>::put(x + W * k, parts[k]);
  return ((x[0] + x[4]) + (x[1] + x[5])) + ((x[2] + x[6]) + (x[3] + x[7]));
}
template <int W, class Distance>
inline void add_lanes(const Pack<W>& zero, Distance& distance, const double* moved,
                      const double* value, const double* beside, int count) {
  Pack<W> size[8 / W];
  Pack<W> scale[8 / W];
  Pack<W> far[8 / W];
  for (int k = 0; k < 8 / W; ++k) size[k] = scale[k] = far[k] = zero;
  for (int j = 0; j < count; j += 8) {
    for (int k = 0; k < 8 / W && j + W * k < count; ++k) {
      const int at = j + W * k;
      const Pack<W> way = lane_abs(Pack<W>::at(moved + at));
      const Pack<W> length = lane_abs(Pack<W>::at(value + at)) + lane_abs(Pack<W>::at(beside + at));
      size[k] += way;
      scale[k] += length;
      const Pack<W> least = distance.units * 0x1p-52 * (length + Distance::tiny);
      far[k] += select(way <= least, zero, way);
    }
  }
  distance.size += total_of<W>(size);
  distance.scale += total_of<W>(scale);
  distance.far += total_of<W>(far);
}
