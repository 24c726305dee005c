// Which lanes have a part in what is solved; the others keep what they have.  All of them check how
// their iterations contract in every 32nd step, the same one, so that they stay in step.
struct Turn {
  Mask lanes = true;
  int step = 0;

  void begin(const Mask& running) {
    lanes = running;
    step = (step + 1) % 32;
  }
  bool is_check() const { return step == 0; }
};
// How far an iteration is in each lane.  One that is done or has failed stands still until all are.
struct Iteration {
  Mask begun = false;
  Mask open = false;  // of these, those that go on
  Mask failed = false;
  Real taken = 0;  // iterations
  Real last = 0;   // increment of a lane that has failed

  void begin(const Turn& turn) {
    begun = open = turn.lanes;
    failed = false;
    taken = 0;
  }
  void end_with(const Mask& lanes, const Real& size) {
    failed = failed | lanes;
    last = select(lanes, size, last);
    open = open & !lanes;
  }
  // Lanes whose matrix is singular or not finite have failed.
  void require(Turn& turn, const Mask& regular) {
    end_with(open & turn.lanes & !regular, Real(__builtin_inf()));
    turn.lanes = turn.lanes & regular;
  }
};
// An iteration has ended; lanes that have failed have no part in what follows.
inline void end_iteration(StepReport& report, Turn& turn, const Iteration& iteration) {
  report.iterations += iteration.taken;
  report.increment = select(report.converged & iteration.failed, iteration.last, report.increment);
  report.converged = report.converged & !iteration.failed;
  turn.lanes = iteration.begun & !iteration.failed;
}
