// NewtonRuleOfMany of an iteration that many steps do without: in lanes that did, these are not
// watched.
template <int Power, int Unknowns>
struct WaitingNewtonRule : NewtonRuleOfMany<Power, Unknowns> {
  using Watched = NewtonRuleOfMany<Power, Unknowns>;
  Mask used = false;

  void begin(const Mask& from_prediction, const Turn& turn) {
    Watched::begin(from_prediction, turn);
    used = used | turn.lanes;
  }
  template <class Past, int All>
  void watch(const Past& past, const Real (&solution)[All], int first, int count) {
    Watched::watch(past, solution, first, count, used);
    used = false;
  }
};
