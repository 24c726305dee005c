// A Refinement whose arrays are looked at in lanes, with the same bits.
template <class Lanes, class Refinement>
struct RefinementInLanes : Refinement {
  static constexpr int width = sizeof(Lanes) / sizeof(double);
  template <int Size>
  bool operator()(double (&point)[Size], const double (&lack)[Size],
                  const double (&gradient)[Size]) {
    if (this->rounds == 0) this->begin(point, lack, gradient);
    constexpr double part = 1 / Refinement::amplifier;  // a power of two
    const Lanes zero = 0;
    Lanes size[8 / width];
    Lanes open[8 / width];
    for (int k = 0; k < 8 / width; ++k) size[k] = open[k] = zero;
    for (int j = 0; j < Size; j += 8) {
      for (int k = 0; k < 8 / width && j + width * k < Size; ++k) {
        const int first = j + width * k;
        const Lanes before = Lanes::at(this->missing + first);
        const Lanes error = before + (Lanes::at(lack + first) - before) * part;
        const Lanes way = Lanes::at(this->moved + first) + error;
        Lanes::put(this->moved + first, way);
        size[k] += lane_abs(error);
        const Lanes unit = 0x1p-52 * lane_abs(Lanes::at(this->at + first)) + lane_abs(way) * 0x1p-7;
        open[k] += select(lane_abs(error) * 8192 > unit, Lanes(1), zero);
        Lanes::put(this->change + first,
                   (Lanes::at(gradient + first) - Lanes::at(this->slope + first)) * part);
      }
    }
    this->last = total_of<width>(size);
    const bool more = this->goes_on(total_of<width>(open) > 0);
    for (int first = 0; first < Size; first += width) {
      const Lanes kept = Lanes::at(this->at + first);
      const Lanes ahead = kept + Refinement::amplifier * Lanes::at(this->moved + first);
      Lanes::put(point + first, more ? ahead : kept);
    }
    return more;
  }
};
