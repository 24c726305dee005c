#include "app/studies/tune_orbit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "runtime/extrapolation.hpp"

namespace hamgen::app {
namespace {

OrbitPoint point_at(const runtime::Library& library, const std::vector<double>& parameters,
                    const std::vector<double>& state) {
  OrbitPoint point;
  point.gradient = library.gradient(parameters, state);
  const std::vector<double> values = library.invariants(parameters, state);
  point.curvature = values[0];
  const std::size_t n = state.size() / 2;
  std::size_t next = 1;
  for (SquareMatrix* block : {&point.by_coordinates, &point.by_momenta, &point.mixed}) {
    for (std::size_t i = 0; i < n; ++i, next += n)
      block->emplace_back(values.begin() + static_cast<std::ptrdiff_t>(next),
                          values.begin() + static_cast<std::ptrdiff_t>(next + n));
  }
  return point;
}

struct BracketTerms {
  std::vector<double> target;                  // -H''(J grad H, J grad H)/24
  std::vector<std::vector<double>> functions;  // by coefficient
};

BracketTerms terms_of(const Orbit& orbit, const GaugeShape& shape) {
  BracketTerms terms;
  terms.functions.resize(shape.size());
  for (const OrbitPoint& point : orbit.points) {
    terms.target.push_back(-point.curvature / 24.0);
    const std::vector<double> values = energy_terms(shape, point.gradient);
    for (std::size_t k = 0; k < values.size(); ++k) terms.functions[k].push_back(values[k]);
  }
  return terms;
}

// No eigenvalue of sign * X Y is above this (Gershgorin); exact for 1 x 1.
double eigenvalue_bound(const SquareMatrix& x, const SquareMatrix& y, double sign) {
  double bound = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    double row = 0.0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      double entry = 0.0;
      for (std::size_t k = 0; k < x.size(); ++k) entry += sign * x[i][k] * y[k][j];
      row += i == j ? entry : std::fabs(entry);
    }
    bound = std::max(bound, row);
  }
  return bound;
}

}  // namespace

Orbit sample_orbit(const SourceText& source, const SceneValues& scene,
                   const OrbitRequest& request) {
  // Both are symmetric and of order 2; the explicit one solves no equations in quad numbers.
  const bool separable = derive(read_model(source, request.method.sizes)).is_separable();
  Request method{.scheme = separable ? "stormer-verlet" : "implicit-midpoint",
                 .observe_curvature = true,
                 .scalar = "quad"};
  method.fold = request.method.fold;
  method.sizes = request.method.sizes;
  const PluginSource plugin = generate_plugin(source, method);
  const std::shared_ptr<const runtime::Library> library =
      load_integrator(plugin, request.compiler, request.stop).library;
  runtime::InitialValues at = initial_values(plugin, scene, *library);
  const std::vector<double> parameters = rounded(at.parameters);
  Orbit orbit;
  orbit.initial_energy = library->energy(parameters, rounded(at.state));
  runtime::ExtrapolationOptions options;
  options.tolerance = 1e-18;  // below the rounding of the doubles that are fitted
  options.first_parts = 1;
  options.stop = request.stop;
  const runtime::Wide distance = wide(request.time / request.samples);
  for (long i = 0; i < request.samples; ++i) {
    if (is_stopped(request.stop)) {
      orbit.failure = "it was stopped";
      return orbit;
    }
    orbit.points.push_back(point_at(*library, parameters, rounded(at.state)));
    const runtime::Extrapolation next = runtime::extrapolate(library, at, distance, options);
    if (!next.failure.empty()) {
      orbit.failure =
          fmt::format("it fails after t = {:.6g}: {}",
                      static_cast<double>(i) * distance.hi + next.reached, next.failure);
      return orbit;
    }
    at.state = next.state;
    if (request.on_progress)
      request.on_progress(static_cast<double>(i + 1) / static_cast<double>(request.samples));
  }
  return orbit;
}

runtime::Flattening fit_gauge(const Orbit& orbit, const GaugeShape& shape) {
  const BracketTerms terms = terms_of(orbit, shape);
  return runtime::flatten(terms.target, terms.functions);
}

double bracket_spread(const Orbit& orbit, const GaugeShape& shape,
                      const std::vector<double>& coefficients) {
  const BracketTerms terms = terms_of(orbit, shape);
  std::vector<double> sums = terms.target;
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    for (std::size_t i = 0; i < sums.size(); ++i)
      sums[i] += coefficients[k] * terms.functions[k][i];
  }
  const auto [low, high] = std::ranges::minmax(sums);
  return high - low;
}

StabilityBound stability_bound(const Orbit& orbit, const GaugeShape& shape,
                               const std::vector<double>& coefficients) {
  const SquareMatrix b = block_of(shape, coefficients, false);
  const SquareMatrix g = block_of(shape, coefficients, true);
  StabilityBound result;
  double largest = 0.0;
  for (const OrbitPoint& point : orbit.points) {
    for (const auto& row : point.mixed) {
      if (std::ranges::any_of(row, [](double x) { return x != 0.0; })) result.known = false;
    }
    largest = std::max({largest, eigenvalue_bound(b, point.by_momenta, -1.0),
                        eigenvalue_bound(g, point.by_coordinates, 1.0)});
  }
  if (largest > 0.0) result.below = 1.0 / std::sqrt(largest);
  return result;
}

}  // namespace hamgen::app
