// NewtonRuleOfMany of an iteration that many steps do without: these are not watched.
template <int Power, int Unknowns>
struct WaitingNewtonRule : NewtonRuleOfMany<Power, Unknowns> {
  using Watched = NewtonRuleOfMany<Power, Unknowns>;
  bool used = false;

  void begin(bool from_prediction) {
    Watched::begin(from_prediction);
    used = true;
  }
  template <class Past, class Solution>
  void watch(const Past& past, const Solution& solution, int first, int count) {
    if (used) {
      Watched::watch(past, solution, first, count);
    } else {
      this->motion = {};
    }
    used = false;
  }
};
