// Integrates over many steps: records, progress, stopping, and a summary.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <span>

#include "runtime/integrator.hpp"

namespace hamgen::runtime {

// What is seen of a state: valid during the call that it is handed to.
struct Record {
  long long step = 0;                // how many were done
  double time = 0.0;                 // step * h, from 0
  std::span<const Wide> state;       // 2n values: q then p; all finite
  Wide energy;                       // H of that state; finite if it is watched
  std::span<const Wide> invariants;  // as many as the model has; these may be not finite
};

// How far a run has come.
struct Progress {
  long long steps_done = 0;  // so far
  long long steps = 0;       // in all
  double seconds = 0.0;      // of wall clock since the beginning
  bool show_rate = true;     // of the steps; false where they only stand for parts of the work
};

struct RunState;

// What integrate() is asked for.
struct IntegrateOptions {
  long long steps = 0;       // not negative
  long long every = 0;       // a record at step 0 and after each so many steps; 0 for no records
  bool watch_energy = true;  // else H is not evaluated, and nothing jumps
  bool end_at_jump = false;  // see Note [jumps]
  std::function<void(const Record&)> on_record;          // called for each record
  std::function<void(const Progress&)> on_progress;      // about once an interval, and at the end
  std::chrono::duration<double> progress_interval{0.1};  // [s]
  const std::atomic<bool>* stop = nullptr;  // looked at as often as progress is reported
  std::optional<double> seconds;            // of wall clock, after which it is out of time
  // Looks at the state at step 0, and each time after as many steps more as it answered; 0 ends the
  // run there.  A record due there comes after it, and none if it ends the run.
  std::function<long long(const Integrator&)> on_look;
  // About once in so many seconds, and where all steps are done, it is stopped or out of time, with
  // what it takes to go on from there.
  std::function<void(const RunState&)> on_save;
  std::chrono::duration<double> save_interval{60.0};  // [s]
  const RunState* from = nullptr;  // goes on from there, bit for bit as if nothing had been
};

// Over the initial state and those after every step.  All values are finite.
struct EnergyStatistics {
  Wide initial;  // H of the start
  Wide min;      // the least
  Wide max;      // the largest
  Wide last;     // of the last state
  // The largest |H - initial|.
  [[nodiscard]] double max_error() const;
  // max - min.
  [[nodiscard]] double spread() const { return difference(max, min); }
  // last - initial.
  [[nodiscard]] double final_error() const { return difference(last, initial); }
};

// What became of a run.
struct RunSummary {
  Status status = Status::done;            // done, or why it ended before
  long long steps_done = 0;                // each with a good state at its end
  long long iterations = 0;                // of the solver, summed over the steps
  int last_iterations = 0;                 // of the step that failed, or the last one
  std::optional<double> last_increment;    // of that step; empty if it was not finite
  std::optional<EnergyStatistics> energy;  // empty if not watched or not finite at the start
  double energy_scale = 0.0;               // see Judge
  double energy_terms = 0.0;               // the same
  std::optional<double> jump;              // the energy error after the step that jumped
  bool ended = false;                      // by on_look, with Status::done
  long long records = 0;                   // handed out
  double advance_seconds = 0.0;            // inside the plugin: processor time of the thread
  double total_seconds = 0.0;              // with records and progress

  [[nodiscard]] double iterations_per_step() const;   // 0 if no step was done
  [[nodiscard]] double nanoseconds_per_step() const;  // inside the plugin; 0 likewise
};

// What integrate() knows between two steps.
struct RunState {
  RunSummary summary;                 // so far
  double jump_limit = 0.0;            // see Note [jumps]
  double largest_error = 0.0;         // of the energy, of the steps done
  std::vector<std::byte> integrator;  // Integrator::saved()
};

// Advances until the steps are done, a step fails, `on_look` ends it, its time is over, or `stop`
// is set.  A step that ends where H is not finite has failed, and one that jumps if they are to end
// the run: the summary, the records and the integrator's state end with the step before.  What it
// did never depends on how the steps were divided into calls.  An exception from a callback passes
// through.  Throws std::invalid_argument for a negative `steps` or `every`, and where `from` is not
// of this integrator.
[[nodiscard]] RunSummary integrate(Integrator& integrator, const IntegrateOptions& options);

}  // namespace hamgen::runtime
