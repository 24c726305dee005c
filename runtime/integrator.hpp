// A running integration: a plugin's state together with the parameters it was created with.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/judge.hpp"
#include "runtime/library.hpp"
#include "runtime/status.hpp"

namespace hamgen::runtime {

// What a run begins with.
struct InitialValues {
  std::vector<Wide> parameters;  // parameter_count values
  Wide h;                        // the step; negative goes back in time
  std::vector<Wide> state;       // 2n values: q then p
  // H and its gradient have a value at every state: what is not finite is an overflow.
  bool defined_everywhere = false;
};

// Over the states after each step of one call.  All are finite.
struct EnergyRange {
  Wide min;   // the least H
  Wide max;   // the largest
  Wide last;  // that of the last state
};

// Of one call of Integrator::advance.
struct Report {
  Status status = Status::done;          // done, or why the next step failed
  long long steps_done = 0;              // by this call, each with a good state at its end
  long long iterations = 0;              // summed over the steps done
  int last_iterations = 0;               // of the step that failed, or the last one
  std::optional<double> last_increment;  // of that step; empty if it was not finite
  std::optional<EnergyRange> energy;     // empty if not watched, not finite, or no step was done
};

// One orbit, from its start on.  It belongs to one thread; any number of them may share a library.
class Integrator {
 public:
  // Throws std::invalid_argument if a size is wrong or a value is not finite.
  Integrator(std::shared_ptr<const Library> library, const InitialValues& start);

  // At most `steps` steps.  On failure the state is the last good one.  With its energy watched, a
  // step that ends where H is not finite is a failure too, and does not count.
  Report advance(long long steps, bool watch_energy);
  // Back to where it was after so many steps of those done, bit for bit: it runs anew from the
  // start, or from the last place that it remembers.
  void go_back_to(long long step);
  // All of it as bytes, for restore() in another process that has the same plugin; empty if the
  // plugin cannot tell.
  [[nodiscard]] std::vector<std::byte> saved() const;
  // The integrator has the same library and start; what it does next is the same to the last bit.
  // Throws std::invalid_argument if these are not its bytes.
  void restore(std::span<const std::byte> bytes);
  // Since the start.
  [[nodiscard]] long long steps_done() const { return steps_done_; }

  // 2n values: q then p.
  [[nodiscard]] std::vector<Wide> state() const;
  // What rounding took from it: the sum of both, exactly, is what the next step starts from.
  [[nodiscard]] std::vector<Wide> carry() const;
  // The state rounded to double; 2n values.
  [[nodiscard]] std::vector<double> rounded_state() const;
  // Of the state, with the digits of the scalar.
  [[nodiscard]] Wide energy() const;
  // invariant_count values, of the state.
  [[nodiscard]] std::vector<Wide> invariants() const;
  // The step size of the start.
  [[nodiscard]] Wide h() const { return start_.h; }
  // The plugin that takes the steps.
  [[nodiscard]] const Library& library() const { return *library_; }
  // What its errors are compared with.
  [[nodiscard]] const Judge& judge() const { return judge_; }

 private:
  struct Destroy {
    const hamgen_plugin* plugin;
    void operator()(hamgen_run* run) const { plugin->destroy(run); }
  };

  // Some thousand steps back at most, where the plugin can tell.
  void remember();

  [[nodiscard]] std::vector<Wide> read(void (*get)(const hamgen_run*, double*, double*)) const;
  hamgen_report call(long long steps, bool watch_energy);
  // Of steps that nobody looks at one by one, the last that ended in numbers.
  hamgen_report last_good(long long before, bool watch_energy);

  // The run is destroyed before the code that does it is unloaded.
  std::shared_ptr<const Library> library_;
  InitialValues start_;
  Judge judge_;
  long long steps_done_ = 0;
  double energy_error_ = 0.0;  // the largest that was watched
  std::unique_ptr<hamgen_run, Destroy> run_;
  long long remembered_step_ = 0;  // 0: the start
  std::vector<std::byte> remembered_;
};

}  // namespace hamgen::runtime
