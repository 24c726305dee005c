// NewtonRule of an iteration that many steps do without: these are not watched.
template <int Power>
struct WaitingNewtonRule : NewtonRule<Power> {
  bool used = false;

  void begin(bool from_prediction) {
    NewtonRule<Power>::begin(from_prediction);
    used = true;
  }
  template <class Past, int Unknowns>
  void watch(const Past& past, const Real (&solution)[Unknowns], int first, int count) {
    if (used) {
      NewtonRule<Power>::watch(past, solution, first, count);
    } else {
      this->motion = {};
    }
    used = false;
  }
};
