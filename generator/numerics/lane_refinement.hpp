// A Refinement whose arrays are looked at in lanes, with the same bits.  The point of another round
// is there before it is known whether one is wanted: all of it hangs on that point.
template <class Lanes, class Refinement>
struct RefinementInLanes : Refinement {
  static_assert(!Refinement::looks_twice, "in double one form is enough");
  static constexpr int width = sizeof(Lanes) / sizeof(double);
  static constexpr int size = Refinement::size;
  bool operator()(double* point, const double* lack, const double* gradient) {
    if (this->rounds == 0) this->begin(point, lack, gradient);
    constexpr double part = 1 / Refinement::amplifier;  // a power of two
    const Lanes zero = 0;
    Lanes moves[8 / width];
    Lanes units[8 / width];
    Lanes open[8 / width];
    for (int k = 0; k < 8 / width; ++k) moves[k] = units[k] = open[k] = zero;
    const Lanes counts = this->times_counted();
    for (int j = 0; j < size; j += 8) {
      for (int k = 0; k < 8 / width && j + width * k < size; ++k) {
        const int first = j + width * k;
        const Lanes before = Lanes::at(this->missing + first);
        const Lanes error = before + (Lanes::at(lack + first) - before) * part;
        const Lanes way = Lanes::at(this->moved + first) + error;
        Lanes::put(this->moved + first, way);
        Lanes::put(point + first, Lanes::at(this->at + first) + Refinement::amplifier * way);
        moves[k] += lane_abs(error);
        Lanes length = lane_abs(Lanes::at(this->at + first));
        if constexpr (Refinement::rounds_beside) length += Lanes(this->beside);
        const Lanes unit = 0x1p-52 * length + lane_abs(way) * 0x1p-7;
        units[k] += lane_abs(error) / (unit + Refinement::tiny);
        open[k] += select(lane_abs(error) * counts > unit, lane_abs(error), zero);
      }
    }
    this->learn_of(total_of<width>(moves), total_of<width>(units));
    if (this->goes_on(total_of<width>(open), lack)) return true;
    for (int first = 0; first < size; first += width)
      Lanes::put(point + first, Lanes::at(this->at + first));
    for (int first = 0; first < Refinement::components; first += width) {
      const Lanes far = Lanes::at(gradient + first) - Lanes::at(this->slope + first);
      Lanes::put(this->change + first, far * part);
    }
    return false;
  }
};
