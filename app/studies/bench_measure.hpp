// What `hamgen bench` measures: errors and run time of one method with one step size.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/studies/load_integrator.hpp"
#include "app/studies/reference.hpp"
#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"
#include "runtime/integrator.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::app {

// A method ready to run.
struct BenchMethod {
  std::string spec;  // as typed
  Request request;
  PluginSource plugin;
  runtime::LoadedPlugin loaded;
  std::string refusal;       // why this model has no such integrator; empty if it has
  bool is_baseline = false;  // to compare with: no answer to what should be used
  StopFlag stop = nullptr;   // ends its runs
};

// Throws ToolError if the compiler fails; a method that does not suit the model is refused.
[[nodiscard]] BenchMethod bench_method(const std::string& spec, const SourceText& source,
                                       const Request& request, const CompilerChoice& compiler,
                                       StopFlag stop = nullptr);

// What tells the time: how long [s] the steps alone take from a start, without records or energies.
using RunClock =
    std::function<double(const BenchMethod&, const runtime::InitialValues& start, long steps)>;
// Runs the steps and returns the processor time they took.
[[nodiscard]] double processor_clock(const BenchMethod& method, const runtime::InitialValues& start,
                                     long steps);

struct BenchRow {
  std::size_t method = 0;  // index among the methods
  Rational h;              // the time divided by `steps`
  long steps = 0;
  std::string outcome;    // "done", or how it failed, and where; empty before it is measured
  std::string unstable;   // how a longer run ends with this step, if badly
  bool is_floor = false;  // rounding: smaller steps are not better
  double iterations_per_step = 0.0;
  double gradients_per_step = 0.0;           // see gradients_per_step
  std::optional<double> energy_error;        // max |H - H(0)| over all steps
  std::optional<double> energy_spread;       // max H - min H
  std::optional<double> later_energy_error;  // as energy_error, of the longer run
  double energy_scale = 0.0;                 // see runtime::Judge::energy_terms
  std::optional<double> state_error;         // |z - z*| at the end, Euclidean
  std::optional<double> q_error;         // the same of the coordinates alone, and of the momenta:
  std::optional<double> p_error;         // they have units of their own
  std::vector<double> invariant_errors;  // max over about 200 states
  double once = 0.0;                     // run time of all steps [s], a first measurement
  std::vector<double> samples;           // the same, one a round
  long runs_per_sample = 1;

  [[nodiscard]] bool ok() const { return outcome == "done"; }
  // The energy error of its scale; empty if either is not known.
  [[nodiscard]] std::optional<double> relative_energy_error() const;
  // That of the longer run, where it is more than twice as much.
  [[nodiscard]] std::optional<double> lasting_energy_error() const;
};

// Medians of the samples per step of the run, and how far they scatter.
struct BenchTime {
  double seconds_per_time = 0.0;  // processor time for a unit of the model's time
  double nanoseconds_per_step = 0.0;
  double spread = 0.0;  // (third quartile - first quartile) / median
};
[[nodiscard]] BenchTime time_of(const BenchRow& row);

// Evaluations of the gradient a step: of V in a splitting, of K in a member of raised order.  An
// iteration for a stage evaluates it once, a step without iterations as often as it has stages; a
// splitting that begins and ends with a kick keeps the last gradient for the next step.
[[nodiscard]] double gradients_per_step(const Method& method, double iterations_per_step);

// Fills errors and outcome by one run that watches the energy, and `runs_per_sample`, so that a
// sample takes about 2 ms or more.
void measure_errors(const BenchMethod& method, const SceneValues& scene,
                    const ReferenceSolution& reference, BenchRow& row,
                    const RunClock& clock = processor_clock);

// The same steps for ten times as long, and 5000 of them at least, for what blows up takes some
// hundreds of long steps to be seen.  Fills in the energy error, and `unstable` if that run fails
// or the error is beyond a hundredth of the scale and a hundred times that of the row.  Nothing if
// it is stopped.
void look_longer(const BenchMethod& method, const SceneValues& scene, BenchRow& row);

// Adds one sample of the run time.
void measure_time(const BenchMethod& method, const SceneValues& scene, BenchRow& row,
                  const RunClock& clock = processor_clock);

}  // namespace hamgen::app
