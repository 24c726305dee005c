// What a step says of each lane.  On failure the increment says how far the iteration was from its
// end; it is not finite where the step left the domain of H.
struct StepReport {
  Mask converged = true;
  Real iterations = 0;
  Real increment = 0;
};
// The sum of the squares of what should be finite: neither an infinity nor NaN.
inline void require_finite(StepReport& report, const Mask& lanes, const Real& length) {
  const Mask finite = (!lanes) | (length <= largest);
  report.increment = select(report.converged & !finite, length, report.increment);
  report.converged = report.converged & finite;
}
inline void require_finite(StepReport& report, const Real& length) {
  require_finite(report, true, length);
}
// Lanes that do not run have no part in the step; those that have failed in it run no more.
inline void stop_failed(Mask& running, StepReport& report) {
  report.iterations = select(running, report.iterations, Real(0));
  report.increment = select(running, report.increment, Real(0));
  running = running & report.converged;
  report.converged = running;
}
// Lanes that have failed from what was known of earlier steps.
inline Mask astray_lanes(const Mask& running, const Mask& known, const StepReport& report) {
  return running & known & !report.converged;
}
// And those whose other solver may find what the first one has not.
inline Mask astray_lanes(const Mask& running, const Mask& known, const StepReport& report,
                         const Real& patience) {
  return astray_lanes(running, known | (patience > 0), report);
}
// Of a lane a substep counts if those before it have succeeded.
inline void add_substep(StepReport& total, const StepReport& report) {
  const Mask lanes = total.converged;
  total.iterations = select(lanes, total.iterations + report.iterations, total.iterations);
  total.increment = select(lanes, report.increment, total.increment);
  total.converged = lanes & report.converged;
}
// What stands in these lanes of `from`.
inline void take_lanes(const Mask& lanes, Real& to, const Real& from) {
  to = select(lanes, from, to);
}
// A step tried again: both count.
inline void take_lanes(const Mask& lanes, StepReport& to, const StepReport& from) {
  take_lanes(lanes, to.iterations, to.iterations + from.iterations);
  take_lanes(lanes, to.increment, from.increment);
  to.converged = to.converged | (lanes & from.converged);
}
// In these lanes value + carry moves by increment and rest; in the others it stays.
inline void move_lanes(const Mask& lanes, Real& value, Real& carry, const Real& increment,
                       const Real& rest) {
  Real moved = value;
  Real lost = carry;
  two_sum_with_rest(moved, lost, increment, rest);
  value = select(lanes, moved, value);
  carry = select(lanes, lost, carry);
}
// For an increment with the old carry in it.
inline void move_lanes(const Mask& lanes, Real& value, Real& carry, const Real& increment) {
  Real moved = value;
  Real lost = carry;
  two_sum(moved, lost, increment);
  value = select(lanes, moved, value);
  carry = select(lanes, lost, carry);
}
// Where sums are plain.
inline void move_lanes(const Mask& lanes, Real& value, const Real& increment) {
  value = select(lanes, value + increment, value);
}
// The sum of many numbers in these lanes, and what rounding loses of it.
inline void collect_lanes(const Mask& lanes, Real& value, Real& lost, const Real& increment) {
  Real sum = value;
  Real error = 0;
  two_sum(sum, error, increment);
  value = select(lanes, sum, value);
  lost = select(lanes, lost + error, lost);
}
