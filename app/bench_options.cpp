#include "app/bench_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/progress_bars.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/scheme_spec.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/mechanics/derive.hpp"

namespace hamgen::app {
namespace {

constexpr long kDefaultSteps = 2000;  // at the scene's h
const std::string kTargets = "1e-4,1e-6,1e-8,1e-10";

std::vector<double> target_values(const std::string& list) {
  std::vector<double> values;
  for (const std::string& text : split_specs(list)) {
    values.push_back(to_double(constant_option("--target", text)));
    if (!(values.back() > 0.0))
      throw UsageError(fmt::format("--target {}: not a positive number", text));
  }
  return values;
}

Observed observed_of(const std::string& text) {
  if (text == "energy") return Observed::energy;
  if (text == "state") return Observed::state;
  throw UsageError(fmt::format("--observe {}: there are energy and state", text));
}

// The step sizes, and the scene whose values have one of them.
void read_steps(const BenchOptions& options, BenchRequest& request) {
  SceneRequest wanted = request.setting.scene;
  // Given steps and time, the scene needs to have neither.
  if (!options.time.empty()) wanted.steps = "1";
  if (!options.steps.empty()) wanted.steps = options.steps;
  const auto complete = [&] {
    request.scene = complete_scene(request.setting.model, wanted, options.length);
  };
  if (options.h.empty()) return complete();
  for (const std::string& h : split_specs(options.h)) {
    wanted.h = h;
    complete();
    request.steps.push_back(*request.scene.h);
  }
  if (!options.time.empty()) return;
  wanted.h = request.setting.scene.h;  // the scene's own time, whatever steps are compared
  complete();
}

Rational run_length(const BenchOptions& options, const BenchRequest& request) {
  if (!options.steps.empty()) {
    if (!options.time.empty())
      throw UsageError(fmt::format("--time {} and --steps {} both say how long\nhelp: drop one",
                                   options.time, options.steps));
    if (*request.scene.steps == 0) throw UsageError("--steps 0: there is nothing to measure");
    return *request.scene.h * *request.scene.steps;
  }
  if (options.time.empty()) return *request.scene.h * std::min(*request.scene.steps, kDefaultSteps);
  const Rational time = constant_option("--time", options.time);
  if (time == 0) throw UsageError("--time 0: there is nothing to measure");
  const Rational& h = request.steps.empty() ? *request.scene.h : request.steps.front();
  if ((time > 0) != (h > 0))
    throw UsageError(fmt::format("--time {} and h = {:g} go in opposite directions", options.time,
                                 to_double(h)));
  return time;
}

// alpha by its own name is a parameter of the step, which the scene of a comparison does not have.
void require_numbers(const std::string& spec, const Request& method, const Setting& setting) {
  const Model model = read_request(setting.source, method);
  if (model.parameters.size() == setting.model.parameters.size()) return;
  const std::string& name = model.parameters[setting.model.parameters.size()].name;
  throw UsageError(
      fmt::format("--schemes {}: {} has no value\nhelp: write a number, or an "
                  "expression in h and the parameters",
                  spec, name));
}

std::vector<BenchSpec> methods_of(const BenchOptions& options, const BenchRequest& request) {
  const Setting& setting = request.setting;
  std::vector<BenchSpec> methods;
  const bool is_offered = options.schemes.empty();
  for (const std::string& spec :
       is_offered ? default_specs(derive(setting.model)) : split_specs(options.schemes)) {
    Request method = request_of_spec(spec, setting.request);
    require_numbers(spec, method, setting);
    take_gauge_at(request.scene, setting.model, method);
    const Scheme* scheme = method.scheme->scheme;
    const bool is_baseline = is_offered && scheme != nullptr && !scheme->symplectic;
    methods.push_back({.spec = spec,
                       .request = std::move(method),
                       .is_offered = is_offered,
                       .is_baseline = is_baseline});
  }
  return methods;
}

}  // namespace

BenchRequest read_bench(const BenchOptions& options) {
  BenchRequest request;
  request.observed = observed_of(options.observe);
  request.targets = target_values(options.target.empty() ? kTargets : options.target);
  request.refines = options.h.empty() || !options.target.empty();
  request.compiler = options.compiler;
  request.setting =
      read_setting({.model = options.model, .plain_sums = options.plain_sums}, options.scene);
  read_steps(options, request);
  specialise(options.scene, request.scene, {}, Observing::everything, request.setting);
  request.time = run_length(options, request);
  request.methods = methods_of(options, request);
  request.rounds = integer_value("--rounds " + options.rounds, options.rounds, 1);
  request.stop = &interrupt_flag();
  request.on_progress = progress_bars(options.quiet);
  return request;
}

}  // namespace hamgen::app
