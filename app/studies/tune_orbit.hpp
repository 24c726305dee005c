// The energy's h^2 term along an accurate orbit, and the gauge that makes it flattest.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/studies/load_integrator.hpp"
#include "app/studies/stop.hpp"
#include "app/studies/tune_gauge.hpp"
#include "generator/language/scene.hpp"
#include "runtime/least_squares.hpp"

namespace hamgen::app {

struct OrbitPoint {
  std::vector<double> gradient;                    // H_q, then H_p
  double curvature = 0.0;                          // H''(J grad H, J grad H)
  SquareMatrix by_coordinates, by_momenta, mixed;  // H_qq, H_pp, H_qp
};

struct Orbit {
  std::vector<OrbitPoint> points;  // at equal distances of time
  double initial_energy = 0.0;
  std::string failure;  // why there are none; empty if there are
};

struct OrbitRequest {
  Request method;  // its sizes and folded parameters count
  Rational time;
  long samples = 0;
  CompilerChoice compiler;
  StopFlag stop = nullptr;
  std::function<void(double)> on_progress = {};  // the fraction that is done
};

// Extrapolation in quad numbers from sample to sample: points lie on the energy surface to all
// digits of a double.
[[nodiscard]] Orbit sample_orbit(const SourceText& source, const SceneValues& scene,
                                 const OrbitRequest& request);

// The coefficients of least variance of the term; spreads and deviations are those of the bracket
// [ (1/2) grad H^T C1 J grad H - (1/24) H''(J grad H, J grad H) ]: times h^2 they are the energy's.
[[nodiscard]] runtime::Flattening fit_gauge(const Orbit& orbit, const GaugeShape& shape);

// max - min of the bracket on the orbit with these coefficients.
[[nodiscard]] double bracket_spread(const Orbit& orbit, const GaugeShape& shape,
                                    const std::vector<double>& coefficients);

// What is sure of the linear stability on this orbit.  For H = p^T T p/2 + q^T V q/2 a step with
// alpha = 1/2 is bounded as long as I + h beta T and I - h gamma V keep their eigenvalues positive.
struct StabilityBound {
  bool known = true;            // false if H has mixed derivatives
  std::optional<double> below;  // for h below this; empty: for every h
};
[[nodiscard]] StabilityBound stability_bound(const Orbit& orbit, const GaugeShape& shape,
                                             const std::vector<double>& coefficients);

}  // namespace hamgen::app
