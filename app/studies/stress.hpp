// What `hamgen stress` measures: a step far outside comfort, cell by cell of a grid.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/studies/progress.hpp"
#include "app/studies/setting.hpp"
#include "app/studies/stop.hpp"
#include "runtime/integrator.hpp"
#include "runtime/library.hpp"

namespace hamgen::app {

struct StressCell {
  std::array<double, 2> at = {};  // the axes' values
  std::optional<double> h;        // empty if undefined
  long steps_done = 0;
  runtime::Status outcome = runtime::Status::done;
  bool bounded = true;                // no component grew beyond 1000 times its size at the start
  double energy_scale = 0.0;          // see runtime::Judge
  double energy_error = 0.0;          // max |H - H(0)| over the states that were reached
  std::optional<double> state_error;  // |z - z*| after all steps, Euclidean
  double state_scale = 0.0;           // the larger of |z| at the start and |z*|
  std::string state_missing;          // why there is no state error
  std::string reason;                 // why it is undefined
  int iterations_median = 0;          // a step
  int iterations_max = 0;
  std::optional<double> h_omega;  // of the fastest linear oscillation at the initial state
  std::optional<bool> linear_bounded;
};

struct StressLimits {
  long steps = 1000;
  std::chrono::duration<double> time{1.0};             // of a cell
  std::chrono::duration<double> reference_time{10.0};  // of all state errors
  StopFlag stop = nullptr;
};

// Runs one cell within the limits; every failure is an outcome.  Returns the last good state.
std::vector<runtime::Wide> run_stress_cell(const std::shared_ptr<const runtime::Library>& library,
                                           const runtime::InitialValues& start,
                                           const StressLimits& limits, StressCell& cell);

// omega^2 of the fastest linear oscillation around a state, whose quadratic part of H is
// differentiated numerically; empty if the fastest motion there is not an oscillation.
[[nodiscard]] std::optional<double> fastest_oscillation(const runtime::Library& library,
                                                        const std::vector<double>& parameters,
                                                        const std::vector<double>& state);

struct StressAxis {
  std::string label;  // "h", "k", "beta"
  bool logarithmic = false;
  std::vector<double> values;  // ascending
};

struct StressMap {
  std::string model, scene, method;
  std::vector<StressAxis> axes;                     // one or two
  std::vector<StressCell> cells;                    // the first axis runs fastest
  std::vector<std::array<double, 2>> linear_bound;  // points of its border in the axes' plane
  long steps = 0;
  std::string references;  // how the states for the state errors were found
  std::string compiler;    // its identity and flags

  [[nodiscard]] std::size_t columns() const { return axes[0].values.size(); }
  [[nodiscard]] std::size_t rows() const { return axes.size() > 1 ? axes[1].values.size() : 1; }
  // The axes' values in a cell.
  [[nodiscard]] std::vector<double> place(std::size_t cell) const {
    std::vector<double> at = {axes[0].values[cell % columns()]};
    if (axes.size() > 1) at.push_back(axes[1].values[cell / columns()]);
    return at;
  }
};

struct StressRequest {
  Setting setting;               // alpha, beta, gamma are the axes' names where these vary them
  std::vector<StressAxis> axes;  // one or two
  StressLimits limits;
  bool of_one_time = false;  // all cells: h must not change
  bool with_bound = false;   // what only a picture shows takes its time: StressMap::linear_bound
  ProgressSink on_progress;
};

// Compiles the integrator and runs all cells, on two threads.  Stopped, it returns early.  Throws
// UsageError, ModelError where no cell is defined, and ToolError.
[[nodiscard]] StressMap stress_map(const StressRequest& request);

}  // namespace hamgen::app
