#include "tests/numerics/emitted_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "app/studies/interpreted.hpp"
#include "generator/algebra/exact.hpp"
#include "generator/base/source_text.hpp"
#include "generator/mechanics/derive.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::numerics_test {

namespace {

runtime::LoadedPlugin loaded(const SourceText& text, const Request& request,
                             const PluginSource& source, Steps steps) {
  if (steps == Steps::interpreted && std::getenv("HAMGEN_COMPILE_STEPS") == nullptr)
    return app::interpreted_integrator(text, request, source);
  const runtime::PluginSource plugin{.text = source.text,
                                     .uses_eigen = source.needs_eigen,
                                     .uses_quadmath = source.needs_quadmath};
  // The same bits by any optimisation, and with this one the compiler takes a third of the time.
  return runtime::load_plugin(plugin, runtime::find_compiler(), {.optimisation = "-O1"},
                              runtime::open_cache());
}

}  // namespace

Emitted::Emitted(const std::string& text, const Request& request, Steps steps)
    : Emitted(make_source("small.ham", "system small\n" + text), request, steps) {}

Emitted Emitted::shipped(const std::string& name, const Request& request) {
  return Emitted(read_source(std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/" + name + ".ham"),
                 request, Steps::compiled);
}

Emitted::Emitted(const SourceText& text, const Request& request, Steps steps)
    : source_(generate_plugin(text, request)),
      library_(loaded(text, request, source_, steps).library) {
  for (const Quantity& parameter : derive(source_.model).parameters) {
    if (std::ranges::find(source_.parameter_names, parameter.name) != source_.parameter_names.end())
      defaults_.push_back(static_cast<long double>(to_double(parameter.value)));
  }
}

runtime::Integrator Emitted::start(const Vector& state, long double h,
                                   const Vector& parameters) const {
  runtime::InitialValues initial{.h = wide(h)};
  for (const long double value : parameters.empty() ? defaults_ : parameters) {
    initial.parameters.push_back(wide(value));
  }
  for (const long double value : state) initial.state.push_back(wide(value));
  return runtime::Integrator(library_, initial);
}

Vector Emitted::after(long long steps, const Vector& state, long double h,
                      const Vector& parameters) const {
  runtime::Integrator run = start(state, h, parameters);
  const runtime::Report report = run.advance(steps, false);
  if (report.status != runtime::Status::done || report.steps_done != steps) {
    throw std::runtime_error("stopped after " + std::to_string(report.steps_done) +
                             " steps: " + std::string(to_text(report.status)));
  }
  return numerics_test::state(run);
}

runtime::Wide wide(long double value) {
  const double hi = static_cast<double>(value);
  return {hi, static_cast<double>(value - static_cast<long double>(hi))};
}

Vector state(const runtime::Integrator& run) {
  Vector values;
  for (const runtime::Wide& value : run.state()) {
    values.push_back(static_cast<long double>(value.hi) + static_cast<long double>(value.lo));
  }
  return values;
}

long double distance(const Vector& a, const Vector& b) {
  if (a.size() != b.size()) throw std::invalid_argument("sizes differ");
  long double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    // Not a number is infinitely far away.
    const long double d = std::abs(a[i] - b[i]);
    if (!(d <= largest)) largest = std::isnan(d) ? INFINITY : d;
  }
  return largest;
}

std::vector<double> observed_orders(const std::vector<long double>& errors) {
  std::vector<double> orders;
  for (std::size_t i = 1; i < errors.size(); ++i) {
    orders.push_back(static_cast<double>(std::log2(errors[i - 1] / errors[i])));
  }
  return orders;
}

}  // namespace hamgen::numerics_test
