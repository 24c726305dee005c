// Constant beta and gamma that flatten the energy of one orbit, and what they are worth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/studies/load_integrator.hpp"
#include "app/studies/progress.hpp"
#include "app/studies/reference.hpp"
#include "app/studies/setting.hpp"
#include "app/studies/stop.hpp"
#include "app/studies/tune_map.hpp"
#include "app/studies/tune_measure.hpp"
#include "app/studies/tune_orbit.hpp"
#include "app/studies/tune_polish.hpp"

namespace hamgen::app {

struct TuneRequest {
  Setting setting;  // its scene has this h and these steps
  SceneValues scene;
  GaugeShape shape;
  Rational time;  // steps * h
  long steps = 0;
  long samples = 1000;  // of the orbit, to fit
  bool polish = false;  // then minimise the measured spread
  CompilerChoice compiler;
  StopFlag stop = nullptr;
  ProgressSink on_progress;
};

struct TunedGauge {
  std::string name;                  // "implicit midpoint", "tuned", "polished"
  std::vector<double> coefficients;  // of h
  double predicted_spread = 0.0;     // of H along the orbit: its h^2 term
  Measurement measured;
  std::optional<double> state_error;  // at the end
  StabilityBound stability;

  // Empty if the run failed.
  [[nodiscard]] std::optional<double> measured_spread() const;
  [[nodiscard]] std::optional<double> measured_error() const;
};

struct TuneReport {
  std::string model, path, scene;
  double h = 0.0;
  double time = 0.0;
  long steps = 0;
  std::size_t samples = 0;
  GaugeShape shape;
  std::size_t rank = 0;
  double initial_energy = 0.0;
  std::vector<TunedGauge> gauges;  // the midpoint rule first, the best last
  int evaluations = 0;             // of the polishing
  bool polish_ended = true;        // at a minimum, not at the most runs that are allowed
  std::string reference_failure;   // why there are no state errors
  std::string orbit_failure;       // why there are no gauges: the orbit cannot be followed
  std::vector<double> shown;       // the last gauge, in the digits that matter
  Request request;                 // of that

  // Energy spread of the midpoint rule over that of the last gauge; empty if one was not measured.
  [[nodiscard]] std::optional<double> gain() const;
  // What energies are compared with: that of the first gauge that was measured; 0 without one.
  [[nodiscard]] double energy_scale() const;
  // Below this the spread is rounding, not an error of the method.
  [[nodiscard]] double rounding() const;
};

struct MapRange {
  double low = 0.0;
  double high = 0.0;
};

struct MapRequest {
  int cells = 0;  // a side
  // Of b and c; empty: from 0 to twice the fitted value.
  std::optional<MapRange> beta, gamma;
};

class Tuner {
 public:
  // Compiles the integrator with the gauge as run-time parameters.
  explicit Tuner(const TuneRequest& request);

  // Fits the gauge, polishes it, measures all.
  [[nodiscard]] TuneReport run();
  // The plane around the fitted pair of the report; for a gauge of one beta and one gamma.
  [[nodiscard]] EnergyMap map(const MapRequest& wanted) const;

 private:
  void follow_orbit();
  void compute_reference();
  void add(const std::string& name, const std::vector<double>& coefficients);
  // Rounded to the fewest digits that measure no worse: those behind them are noise.
  [[nodiscard]] std::vector<double> in_few_digits(const std::vector<double>& coefficients) const;
  [[nodiscard]] double spread_of(const std::vector<double>& coefficients) const;
  void polish_all();
  [[nodiscard]] Polished polish_from(const std::function<double(const std::vector<double>&)>& value,
                                     const std::vector<double>& start) const;

  TuneRequest request_;
  double h_;
  GaugedIntegrator integrator_;
  Orbit orbit_;
  ReferenceSolution reference_;
  TuneReport report_;
};

}  // namespace hamgen::app
