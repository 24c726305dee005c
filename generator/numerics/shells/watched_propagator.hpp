// Where the value of an event is zero: after a part theta, in (0, 1], of a step.
struct Crossing {
  Event event;
  Real theta;
  Real time;
  State state;  // after one step of length theta h from the state before
};

// A Propagator whose steps are looked into; they are its own, whatever is found.
class WatchedPropagator {
 public:
  explicit WatchedPropagator(const Propagator& propagator) : propagator_(propagator) { begin(); }

  // One step, then visit(crossing) for each event within it, in the order of time: true ends the
  // run there.  In a step that fails nothing is looked for.
  template <class Visit>
  StepReport step(const Visit& visit) {
    before_ = after_;
    ended_ = false;
    const StepReport report = propagator_.step();
    if (!report.converged) return report;
    read();
    look(visit);
    return report;
  }

  // Up to `steps` steps, the last one that in which visit(crossing) is true; stops at the first
  // failure.  The report sums the iterations.
  template <class Visit>
  StepReport advance(long long steps, const Visit& visit) {
    StepReport total;
    total.converged = true;
    for (long long i = 0; i < steps; ++i) {
      const StepReport report = step(visit);
      total.iterations += report.iterations;
      total.increment = report.increment;
      total.converged = report.converged;
      if (!report.converged || ended_) break;
    }
    return total;
  }

  // The state after a part theta of the last step, from 0 to 1, or of one that failed: one step of
  // length theta h from the state before.  On failure z is left unchanged.
  [[nodiscard]] StepReport at(Real theta, State& z) const {
    Propagator part(propagator_.parameters(), theta * propagator_.h(), before_.state);
    StepReport report;
    report.converged = theta == 0;
    if (theta != 0) report = part.step();
    if (report.converged) z = part.state();
    return report;
  }

  // Begins anew at z.
  void reset(const State& z) {
    propagator_.reset(z);
    begin();
  }

  [[nodiscard]] const Propagator& propagator() const { return propagator_; }
  // Did visit(crossing) end the run, in the last step?
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  struct Side {
    State state;
    Real time;
    Real gradient[Watched::variables];
    Real values[Watched::events];
  };

  void begin() {
    read();
    before_ = after_;
    ended_ = false;
  }

  void read() {
    after_.state = propagator_.state();
    after_.time = propagator_.time();
    gradient(propagator_.parameters(), after_.state, after_.gradient);
    events(propagator_.parameters(), after_.state, after_.values);
  }

  template <class Visit>
  void look(const Visit& visit) {
    CrossingList<Watched::events> list;
    for (int i = 0; i < Watched::events; ++i) {
      const auto value = [&](Real theta, Real& result) {
        State z;
        if (!at(theta, z).converged) return false;
        result = value_of(i, z);
        return magnitude(result) <= largest;
      };
      const auto on_cubic = [&](Real s) {
        return value_of(i, Watched::cubic(s, propagator_.h(), before_.state, before_.gradient,
                                          after_.state, after_.gradient));
      };
      find_crossings(value, on_cubic, before_.values[i], after_.values[i], Watched::rising[i],
                     Watched::falling[i], [&](Real theta) { list.insert(i, theta); });
    }
    for (int k = 0; k < list.count && !ended_; ++k) {
      const Real theta = list.theta[k];
      Crossing crossing = {static_cast<Event>(list.event[k]), theta,
                           before_.time + theta * propagator_.h(), after_.state};
      if (theta < 1 && !at(theta, crossing.state).converged) continue;
      ended_ = visit(static_cast<const Crossing&>(crossing));
    }
  }

  Real value_of(int i, const State& z) const {
    Real values[Watched::events];
    events(propagator_.parameters(), z, values);
    return values[i];
  }

  Propagator propagator_;
  Side before_, after_;  // the last step
  bool ended_ = false;
};
