#include "app/studies/tune_measure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "runtime/trajectory.hpp"

namespace hamgen::app {

GaugedIntegrator::GaugedIntegrator(const SourceText& source, const Request& base,
                                   const GaugeShape& shape, const SceneRequest& scene,
                                   const CompilerChoice& compiler, StopFlag stop)
    : stop_(stop) {
  Request request = base;
  for (std::size_t k = 0; k < shape.size(); ++k)
    request.scheme_parameters.push_back(fmt::format("tuned_{}", k + 1));
  const GaugeTexts texts = gauge_texts(shape, request.scheme_parameters);
  request.beta = texts.beta;
  request.gamma = texts.gamma;
  plugin_ = generate_plugin(source, request);
  library_ = load_integrator(plugin_, compiler, stop).library;
  scene_ = complete_scene(plugin_.model, scene);
  start_ = initial_values(plugin_, scene_, *library_);
  for (const std::string& name : request.scheme_parameters) {
    const auto found = std::ranges::find(plugin_.parameter_names, name);
    places_.emplace_back();
    if (found != plugin_.parameter_names.end())
      places_.back() = static_cast<std::size_t>(found - plugin_.parameter_names.begin());
  }
}

Measurement GaugedIntegrator::measure(const std::vector<double>& coefficients, double h,
                                      long steps) const {
  runtime::InitialValues start = start_;
  start.h = {.hi = h};
  for (std::size_t k = 0; k < places_.size(); ++k) {
    if (places_[k]) start.parameters[*places_[k]] = {.hi = coefficients[k]};
  }
  runtime::Integrator integrator(library_, start);
  runtime::IntegrateOptions options;
  options.steps = steps;
  options.stop = stop_;
  const runtime::RunSummary summary = runtime::integrate(integrator, options);
  Measurement result;
  if (summary.status != runtime::Status::done || !summary.energy) {
    result.failure =
        fmt::format("{} in step {}", runtime::to_text(summary.status), summary.steps_done + 1);
    return result;
  }
  result.energy_spread = summary.energy->spread();
  result.energy_error = summary.energy->max_error();
  result.energy_scale = summary.energy_terms;
  result.state = whole_state(plugin_, scene_, integrator.state());
  return result;
}

}  // namespace hamgen::app
