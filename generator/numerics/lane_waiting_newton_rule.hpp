// NewtonRule of an iteration that many steps do without: in lanes that did, these are not watched.
template <int Power>
struct WaitingNewtonRule : NewtonRule<Power> {
  Mask used = false;

  void begin(const Mask& from_prediction, const Turn& turn) {
    NewtonRule<Power>::begin(from_prediction, turn);
    used = used | turn.lanes;
  }
  template <class Past, int Unknowns>
  void watch(const Past& past, const Real (&solution)[Unknowns], int first, int count) {
    if (any(used)) NewtonRule<Power>::watch(past, solution, first, count);
    this->motion.move = select(used, this->motion.move, Real(0));
    this->motion.bend = select(used, this->motion.bend, Real(0));
    used = false;
  }
};
