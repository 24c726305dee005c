// The paper's pendulum H = p^2/2 - eps cos q, eps = 0.03, run through compiled integrators.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/integrator.hpp"

namespace hamgen {
struct Request;
}

namespace hamgen::paper {

constexpr long double kEps = 0.03L;

// H(q, p).
[[nodiscard]] long double hamiltonian(long double q, long double p);

// alpha, beta, gamma of the paper's family.
struct Gauge {
  long double alpha = 0.5L;
  long double beta = 0.0L;
  long double gamma = 0.0L;
};

// A compiled integrator of the pendulum.
struct CompiledScheme {
  std::string name;  // for tables
  std::vector<std::string> parameter_names;
  std::shared_ptr<const runtime::Library> library;
};

// Throws ToolError.
[[nodiscard]] CompiledScheme compile_scheme(const std::string& name, const Request& request);

struct Start {
  long double q = 0.0L;  // at rest
  long double h = 0.0L;  // negative goes back in time
  Gauge gauge = {};      // of no effect on methods that are no members
};

struct State {
  long double q = 0.0L;
  long double p = 0.0L;
};

struct Sample {
  long double t = 0.0L;
  State state;
  long double error = 0.0L;  // H - H(0)
};

// Over all states, the initial one included.
struct Orbit {
  runtime::Status status = runtime::Status::done;
  long steps_done = 0;
  State end;
  long double min = 0.0L;  // of H - H(0)
  long double max = 0.0L;
  long double largest_change = 0.0L;  // of H from one step to the next
  long double largest_angle = 0.0L;   // |q|

  [[nodiscard]] double spread() const { return static_cast<double>(max - min); }
  [[nodiscard]] double max_error() const { return static_cast<double>(max > -min ? max : -min); }
  // Beyond the upper equilibrium: the pendulum, started at rest, went over the top.
  [[nodiscard]] bool escaped() const;
};

// At most `steps` steps; `see` is called for the initial state and after each step.  H is evaluated
// here in long double, of the state to all the digits the method has.
[[nodiscard]] Orbit integrate(const CompiledScheme& scheme, const Start& start, long steps,
                              const std::function<void(const Sample&)>& see = {});

// As above from any state.
[[nodiscard]] Orbit integrate_from(const CompiledScheme& scheme, const State& from,
                                   const Start& start, long steps,
                                   const std::function<void(const Sample&)>& see = {});

// The state after `time` from rest at q, to more than 25 digits; `midpoint` is the implicit
// midpoint rule in quad precision.
[[nodiscard]] State exact_state(const CompiledScheme& midpoint, long double q, long double time);

[[nodiscard]] double distance(const State& a, const State& b);

// Calls task(0), ..., task(count - 1), each once, from as many threads as there are processors.
void in_parallel(int count, const std::function<void(int)>& task);

}  // namespace hamgen::paper
