// A running integration: a plugin's state together with the parameters it was created with.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "runtime/library.hpp"

namespace hamgen::runtime {

// A number wider than a double, as the sum hi + lo.
struct Wide {
  double hi = 0.0;
  double lo = 0.0;

  friend bool operator==(const Wide&, const Wide&) = default;
};

struct InitialValues {
  std::vector<Wide> parameters;  // parameter_count values
  Wide h;                        // the step; negative goes back in time
  std::vector<Wide> state;       // 2n values: q then p
};

enum class Status { done, not_converged, not_finite, stopped };

// "done", "not converged", "not finite", "stopped".
[[nodiscard]] std::string_view to_text(Status status);

// Over the states after each step of one call.  All are finite.
struct EnergyRange {
  double min = 0.0;
  double max = 0.0;
  double last = 0.0;
};

struct Report {
  Status status = Status::done;
  long long steps_done = 0;
  long long iterations = 0;              // summed over the steps done
  int last_iterations = 0;               // of the step that failed, or the last one
  std::optional<double> last_increment;  // of that step; empty if it was not finite
  std::optional<EnergyRange> energy;     // empty if not watched, not finite, or no step was done
};

class Integrator {
 public:
  // Throws std::invalid_argument if a size is wrong or a value is not finite.
  Integrator(std::shared_ptr<const Library> library, const InitialValues& start);

  // At most `steps` steps.  On failure the state is the last good one.  An energy that is not
  // finite is a failure too (Status::not_finite), found at the end of the call.
  Report advance(long long steps, bool watch_energy);

  [[nodiscard]] std::vector<Wide> state() const;
  // The state rounded to double; 2n values.
  [[nodiscard]] std::vector<double> rounded_state() const;
  [[nodiscard]] double energy() const;
  [[nodiscard]] std::vector<double> invariants() const;

  [[nodiscard]] const std::vector<double>& parameters() const { return parameters_; }
  [[nodiscard]] Wide h() const { return h_; }
  [[nodiscard]] const Library& library() const { return *library_; }

 private:
  struct Destroy {
    const hamgen_plugin* plugin;
    void operator()(hamgen_run* run) const { plugin->destroy(run); }
  };

  // The run is destroyed before the code that does it is unloaded.
  std::shared_ptr<const Library> library_;
  std::vector<double> parameters_;
  Wide h_;
  std::unique_ptr<hamgen_run, Destroy> run_;
};

}  // namespace hamgen::runtime
