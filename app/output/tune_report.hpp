// What `hamgen tune` says of the gauges it compared.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/studies/tune_measure.hpp"
#include "app/studies/tune_orbit.hpp"

namespace hamgen::app {

struct TunedGauge {
  std::string name;                  // "implicit midpoint", "tuned", "polished"
  std::vector<double> coefficients;  // of h
  double predicted_spread = 0.0;     // of H along the orbit: its h^2 term
  Measurement measured;
  std::optional<double> state_error;  // at the end
  StabilityBound stability;
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
  std::string command;             // `hamgen generate` with the last gauge

  // Energy spread of the midpoint rule over that of the last gauge; empty if one was not measured.
  [[nodiscard]] std::optional<double> gain() const;
  // Below this the spread is rounding, not an error of the method.
  [[nodiscard]] double rounding() const;
};

[[nodiscard]] std::string tune_text(const TuneReport& report);
[[nodiscard]] std::string tune_json(const TuneReport& report);
// One or two sentences on whether it is worth while.
[[nodiscard]] std::string verdict_of(const TuneReport& report);

}  // namespace hamgen::app
