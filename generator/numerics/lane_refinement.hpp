// A Refinement whose arrays are looked at in lanes, with the same bits.
template <class Lanes, class Refinement>
struct RefinementInLanes : Refinement {
  static constexpr int width = sizeof(Lanes) / sizeof(double);
  static constexpr int size = Refinement::size;
  bool operator()(double* point, const double* lack, const double* gradient) {
    if (this->rounds == 0) this->begin(point, lack, gradient);
    constexpr double part = 1 / Refinement::amplifier;  // a power of two
    const Lanes zero = 0;
    Lanes moves[8 / width];
    Lanes open[8 / width];
    for (int k = 0; k < 8 / width; ++k) moves[k] = open[k] = zero;
    for (int j = 0; j < size; j += 8) {
      for (int k = 0; k < 8 / width && j + width * k < size; ++k) {
        const int first = j + width * k;
        const Lanes before = Lanes::at(this->missing + first);
        const Lanes error = before + (Lanes::at(lack + first) - before) * part;
        const Lanes way = Lanes::at(this->moved + first) + error;
        Lanes::put(this->moved + first, way);
        moves[k] += lane_abs(error);
        const Lanes unit = 0x1p-52 * lane_abs(Lanes::at(this->at + first)) + lane_abs(way) * 0x1p-7;
        open[k] += select(lane_abs(error) * 8192 > unit, lane_abs(error), zero);
      }
    }
    this->last = total_of<width>(moves);
    const bool more = this->goes_on(total_of<width>(open), lack);
    if (more) {
      for (int first = 0; first < size; first += width) {
        const Lanes ahead = Refinement::amplifier * Lanes::at(this->moved + first);
        Lanes::put(point + first, Lanes::at(this->at + first) + ahead);
      }
      return true;
    }
    for (int first = 0; first < size; first += width)
      Lanes::put(point + first, Lanes::at(this->at + first));
    for (int first = 0; first < Refinement::components; first += width) {
      const Lanes far = Lanes::at(gradient + first) - Lanes::at(this->slope + first);
      Lanes::put(this->change + first, far * part);
    }
    return false;
  }
};
