#include "app/studies/tune.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace hamgen::app {
namespace {

MapAxis axis(const std::optional<MapRange>& range, int cells, double tuned, double scale) {
  if (range) return {.low = range->low, .high = range->high, .count = cells};
  const double end = tuned != 0.0 ? 2 * tuned : scale / 6;
  return {.low = std::min(0.0, end), .high = std::max(0.0, end), .count = cells};
}

}  // namespace

std::optional<double> TunedGauge::measured_spread() const {
  if (!measured.failure.empty()) return std::nullopt;
  return measured.energy_spread;
}

std::optional<double> TunedGauge::measured_error() const {
  if (!measured.failure.empty()) return std::nullopt;
  return measured.energy_error;
}

std::optional<double> TuneReport::gain() const {
  const std::optional<double> before = gauges.front().measured_spread();
  const std::optional<double> after = gauges.back().measured_spread();
  if (!before || !after || *after == 0.0) return std::nullopt;
  return *before / *after;
}

double TuneReport::energy_scale() const {
  const auto measured = std::ranges::find_if(
      gauges, [](const TunedGauge& gauge) { return gauge.measured.energy_scale > 0.0; });
  return measured == gauges.end() ? 0.0 : measured->measured.energy_scale;
}

double TuneReport::rounding() const { return 1e-13 * energy_scale(); }

Tuner::Tuner(const TuneRequest& request)
    : request_(request),
      h_(to_double(*request.scene.h)),
      integrator_(request.setting.source, request.setting.request, request.shape,
                  request.setting.scene, request.compiler, request.stop) {}

TuneReport Tuner::run() {
  report_ = {.model = request_.setting.model.name,
             .path = request_.setting.source.path,
             .scene = request_.scene.name,
             .h = h_,
             .time = to_double(request_.time),
             .steps = request_.steps,
             .shape = request_.shape};
  follow_orbit();
  if (!report_.orbit_failure.empty()) return report_;
  compute_reference();
  if (is_stopped(request_.stop)) return report_;
  const runtime::Flattening flat = fit_gauge(orbit_, request_.shape);
  report_.rank = flat.rank;
  add("implicit midpoint", std::vector<double>(request_.shape.size(), 0.0));
  add("tuned", flat.coefficients);
  if (request_.polish) polish_all();
  report_.request = request_.setting.request;
  report_.shown = in_few_digits(report_.gauges.back().coefficients);
  const GaugeTexts texts = gauge_texts(request_.shape, number_texts(report_.shown));
  report_.request.beta = texts.beta;
  report_.request.gamma = texts.gamma;
  return report_;
}

EnergyMap Tuner::map(const MapRequest& wanted) const {
  const std::vector<double>& pair = report_.gauges[1].coefficients;
  const MapAxis b = axis(wanted.beta, wanted.cells, pair[0], std::fabs(orbit_.initial_energy));
  const MapAxis c = axis(wanted.gamma, wanted.cells, pair[1], 1.0);
  Work work(request_.on_progress, "map", static_cast<long long>(b.count) * c.count);
  EnergyMap map =
      energy_map(integrator_, b, c, h_, request_.steps, request_.stop,
                 [&work](std::size_t done) { work.tell(static_cast<long long>(done)); });
  map.fitted = {pair[0], pair[1]};
  // With beta = -h or gamma = h the bound is h < r, so -b h^2 and c h^2 are to be below r^2.
  const StabilityBound of_b = stability_bound(orbit_, request_.shape, {-1.0, 0.0});
  const StabilityBound of_c = stability_bound(orbit_, request_.shape, {0.0, 1.0});
  if (of_b.known && of_b.below) map.lowest_b = -std::pow(*of_b.below / h_, 2);
  if (of_c.known && of_c.below) map.highest_c = std::pow(*of_c.below / h_, 2);
  return map;
}

void Tuner::follow_orbit() {
  Work work(request_.on_progress, "orbit");
  orbit_ = sample_orbit(request_.setting.source, request_.scene,
                        {.method = request_.setting.request,
                         .time = request_.time,
                         .samples = request_.samples,
                         .compiler = request_.compiler,
                         .stop = request_.stop,
                         .on_progress = work.fraction()});
  report_.samples = orbit_.points.size();
  report_.initial_energy = orbit_.initial_energy;
  report_.orbit_failure = orbit_.failure;
}

void Tuner::compute_reference() {
  Work work(request_.on_progress, "reference");
  reference_ = reference_solution(request_.setting.source, request_.scene, request_.time,
                                  {.sizes = request_.setting.request.sizes,
                                   .compiler = request_.compiler,
                                   .stop = request_.stop,
                                   .on_progress = work.fraction()});
  report_.reference_failure = reference_.failure;
}

void Tuner::add(const std::string& name, const std::vector<double>& coefficients) {
  TunedGauge gauge{.name = name, .coefficients = coefficients};
  gauge.predicted_spread = h_ * h_ * bracket_spread(orbit_, request_.shape, coefficients);
  gauge.measured = integrator_.measure(coefficients, h_, request_.steps);
  if (gauge.measured.failure.empty() && !reference_.state.empty())
    gauge.state_error = distance(gauge.measured.state, reference_.state);
  gauge.stability = stability_bound(orbit_, request_.shape, coefficients);
  report_.gauges.push_back(std::move(gauge));
}

double Tuner::spread_of(const std::vector<double>& coefficients) const {
  const Measurement measured = integrator_.measure(coefficients, h_, request_.steps);
  return measured.failure.empty() ? measured.energy_spread : HUGE_VAL;
}

std::vector<double> Tuner::in_few_digits(const std::vector<double>& coefficients) const {
  constexpr double no_worse = 1.001;
  const double whole = spread_of(coefficients);
  for (int digits = 3; digits < 17; ++digits) {
    std::vector<double> rounded;
    for (const double x : coefficients)
      rounded.push_back(std::strtod(fmt::format("{:.{}g}", x, digits).c_str(), nullptr));
    if (spread_of(rounded) <= no_worse * whole) return rounded;
  }
  return coefficients;
}

// From the narrowest form on, each from the better of its own fit and of the form before: a wider
// form never ends worse than one that it contains.
void Tuner::polish_all() {
  std::vector<double> best = report_.gauges.back().coefficients;
  std::optional<GaugeShape> before;
  for (const GaugeForm form : {GaugeForm::scalar, GaugeForm::diagonal, GaugeForm::matrix}) {
    if (form > request_.shape.form) break;
    const GaugeShape shape = {.form = form, .n = request_.shape.n};
    if (before && shape.size() == before->size()) continue;
    const auto value = [&](const std::vector<double>& coefficients) {
      return spread_of(widened(shape, coefficients, request_.shape));
    };
    std::vector<double> start = fit_gauge(orbit_, shape).coefficients;
    if (before) {
      std::vector<double> narrow = widened(*before, best, shape);
      if (!(value(start) < value(narrow))) start = std::move(narrow);
    }
    const Polished polished = polish_from(value, start);
    best = polished.coefficients;
    report_.evaluations += polished.evaluations;
    report_.polish_ended = polished.ended;
    before = shape;
  }
  add("polished", widened(*before, best, request_.shape));
}

Polished Tuner::polish_from(const std::function<double(const std::vector<double>&)>& value,
                            const std::vector<double>& start) const {
  constexpr int most_runs = 400;  // a coefficient
  // The next term of the energy is O(h^2) smaller: the best coefficients are near.
  double largest = 0.0;
  for (const double x : start) largest = std::max(largest, std::fabs(x));
  if (largest == 0.0) return {.coefficients = start, .ended = true};
  std::vector<double> steps = start;
  for (double& x : steps) x = 1e-3 * (x != 0.0 ? std::fabs(x) : largest);
  return polish(value, start, steps, most_runs * static_cast<int>(start.size()), request_.stop);
}

}  // namespace hamgen::app
