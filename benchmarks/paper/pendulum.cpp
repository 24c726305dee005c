#include "benchmarks/paper/pendulum.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <numbers>
#include <stdexcept>
#include <thread>
#include <vector>

#include "generator/base/source_text.hpp"
#include "generator/pipeline.hpp"
#include "runtime/compiler.hpp"
#include "runtime/extrapolation.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::paper {
namespace {

runtime::Wide wide(long double value) {
  const auto hi = static_cast<double>(value);
  return {.hi = hi, .lo = static_cast<double>(value - hi)};
}

long double sum(const runtime::Wide& value) {
  return static_cast<long double>(value.hi) + value.lo;
}

long double parameter(const std::string& name, const Gauge& gauge) {
  if (name == "eps") return kEps;
  if (name == "alpha") return gauge.alpha;
  if (name == "beta") return gauge.beta;
  if (name == "gamma") return gauge.gamma;
  throw std::logic_error("the pendulum has no parameter " + name);
}

runtime::InitialValues initial_values(const CompiledScheme& scheme, const State& from,
                                      const Start& start) {
  runtime::InitialValues values{.h = wide(start.h), .state = {wide(from.q), wide(from.p)}};
  for (const std::string& name : scheme.parameter_names)
    values.parameters.push_back(wide(parameter(name, start.gauge)));
  return values;
}

State state_of(const std::vector<runtime::Wide>& values) {
  return {.q = sum(values[0]), .p = sum(values[1])};
}

}  // namespace

long double hamiltonian(long double q, long double p) { return p * p / 2 - kEps * std::cos(q); }

bool Orbit::escaped() const { return largest_angle > std::numbers::pi_v<long double>; }

CompiledScheme compile_scheme(const std::string& name, const Request& request) {
  const PluginSource plugin = generate_plugin(read_source("hamiltonians/pendulum.ham"), request);
  runtime::PluginSource source;
  source.text = plugin.text;
  source.uses_quadmath = plugin.needs_quadmath;
  return {
      .name = name,
      .parameter_names = plugin.parameter_names,
      .library = runtime::load_plugin(source, runtime::find_compiler(), {}, runtime::open_cache())
                     .library};
}

Orbit integrate_from(const CompiledScheme& scheme, const State& from, const Start& start,
                     long steps, const std::function<void(const Sample&)>& see) {
  runtime::Integrator integrator(scheme.library, initial_values(scheme, from, start));
  Orbit orbit{.end = state_of(integrator.state())};
  const long double before = hamiltonian(orbit.end.q, orbit.end.p);
  long double last = 0.0L;
  if (see) see({.state = orbit.end});
  for (long step = 1; step <= steps; ++step) {
    const runtime::Report report = integrator.advance(1, false);
    orbit.status = report.status;
    if (report.status != runtime::Status::done) break;
    orbit.steps_done = step;
    orbit.end = state_of(integrator.state());
    const long double error = hamiltonian(orbit.end.q, orbit.end.p) - before;
    orbit.min = std::min(orbit.min, error);
    orbit.max = std::max(orbit.max, error);
    orbit.largest_change = std::max(orbit.largest_change, std::fabs(error - last));
    orbit.largest_angle = std::max(orbit.largest_angle, std::fabs(orbit.end.q));
    last = error;
    if (see) see({.t = step * start.h, .state = orbit.end, .error = error});
  }
  return orbit;
}

Orbit integrate(const CompiledScheme& scheme, const Start& start, long steps,
                const std::function<void(const Sample&)>& see) {
  return integrate_from(scheme, {.q = start.q}, start, steps, see);
}

State exact_state(const CompiledScheme& midpoint, long double q, long double time) {
  const runtime::InitialValues start = initial_values(midpoint, {.q = q}, {});
  const runtime::Extrapolation solution = runtime::extrapolate(midpoint.library, start, wide(time));
  if (!solution.failure.empty()) throw std::runtime_error("reference: " + solution.failure);
  return state_of(solution.state);
}

double distance(const State& a, const State& b) {
  return static_cast<double>(std::hypot(a.q - b.q, a.p - b.p));
}

void in_parallel(int count, const std::function<void(int)>& task) {
  std::atomic<int> next = 0;
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (int i = next++; i < count; i = next++) task(i);
    } catch (...) {
      const std::lock_guard lock(failure_mutex);
      failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) threads.emplace_back(work);
  work();
  threads.clear();  // joins
  if (failure) std::rethrow_exception(failure);
}

}  // namespace hamgen::paper
