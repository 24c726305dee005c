#include "app/studies/interpreted.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "generator/base/diagnostic.hpp"
#include "generator/formats/scalar.hpp"
#include "generator/interpreter/interpreter.hpp"

namespace hamgen::app {

namespace {

// The functions of the interface have no place for what they belong to: it is here.
template <class Real>
struct Interpreted {
  StepCode code;
  std::string description, solver;
  hamgen_plugin table = {};
  std::size_t parameters = 0;
  std::size_t state = 0;
  std::unique_ptr<Interpreter<Real>> functions;  // H and the like, made when they are first wanted

  static inline Interpreted* now = nullptr;
  Interpreted() { now = this; }
  Interpreted(const Interpreted&) = delete;
  Interpreted& operator=(const Interpreted&) = delete;
  ~Interpreted() { now = nullptr; }
};

template <class Real>
std::vector<Real> read(const double* values, const double* low, std::size_t count) {
  std::vector<Real> result;
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(static_cast<Real>(values[i]) +
                     (low != nullptr ? static_cast<Real>(low[i]) : Real(0)));
  }
  return result;
}

template <class Real>
hamgen_run* create(const double* parameters, const double* parameters_low, double h, double h_low,
                   const double* state, const double* state_low) {
  const Interpreted<Real>& now = *Interpreted<Real>::now;
  auto* interpreter = new Interpreter<Real>(
      now.code, read<Real>(parameters, parameters_low, now.parameters),
      static_cast<Real>(h) + static_cast<Real>(h_low), read<Real>(state, state_low, now.state));
  return reinterpret_cast<hamgen_run*>(interpreter);  // opaque to the runtime
}

template <class Real>
Interpreter<Real>& interpreter_of(hamgen_run* run) {
  return *reinterpret_cast<Interpreter<Real>*>(run);
}
template <class Real>
const Interpreter<Real>& interpreter_of(const hamgen_run* run) {
  return *reinterpret_cast<const Interpreter<Real>*>(run);
}

template <class Real>
void destroy(hamgen_run* run) {
  delete reinterpret_cast<Interpreter<Real>*>(run);
}

// As the compiled one does it.
template <class Real>
void advance(hamgen_run* run, long long steps, int watch_energy, hamgen_report* report) {
  Interpreter<Real>& interpreter = interpreter_of<Real>(run);
  *report = {HAMGEN_DONE, 0, 0, 0, 0.0, 0.0, 0.0, 0.0};
  for (long long i = 0; i < steps; ++i) {
    const auto last = interpreter.step();
    report->last_iterations = static_cast<int>(last.iterations);
    report->last_increment = static_cast<double>(last.increment);
    if (!last.converged) {
      report->status =
          std::isfinite(report->last_increment) ? HAMGEN_NOT_CONVERGED : HAMGEN_NOT_FINITE;
      return;
    }
    ++report->steps_done;
    report->iterations += last.iterations;
    if (watch_energy == 0) continue;
    const auto energy = static_cast<double>(interpreter.energy(interpreter.state()));
    const bool first = report->steps_done == 1;
    report->energy_min = first ? energy : std::min(report->energy_min, energy);
    report->energy_max = first ? energy : std::max(report->energy_max, energy);
    report->energy_last = energy;
    if (std::isfinite(energy)) continue;
    report->status = HAMGEN_NOT_FINITE;
    return;
  }
}

template <class Real>
void get_state(const hamgen_run* run, double* state, double* low) {
  const std::vector<Real>& numbers = interpreter_of<Real>(run).state();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    state[i] = static_cast<double>(numbers[i]);
    if (low != nullptr) low[i] = static_cast<double>(numbers[i] - static_cast<Real>(state[i]));
  }
}

template <class Real>
Interpreter<Real>& functions_with(const double* parameters, std::vector<Real>& state,
                                  const double* values) {
  Interpreted<Real>& now = *Interpreted<Real>::now;
  const std::vector<Real> par = read<Real>(parameters, nullptr, now.parameters);
  state = read<Real>(values, nullptr, now.state);
  if (!now.functions) {
    now.functions = std::make_unique<Interpreter<Real>>(now.code, par, Real(1), state);
  }
  now.functions->evaluate_with(par);
  return *now.functions;
}

template <class Real>
double energy(const double* parameters, const double* state) {
  std::vector<Real> z;
  Interpreter<Real>& functions = functions_with<Real>(parameters, z, state);
  return static_cast<double>(functions.energy(z));
}

template <class Real>
void write(const std::vector<Real>& numbers, double* values) {
  std::ranges::transform(numbers, values, [](Real x) { return static_cast<double>(x); });
}

template <class Real>
void invariants(const double* parameters, const double* state, double* values) {
  std::vector<Real> z;
  Interpreter<Real>& functions = functions_with<Real>(parameters, z, state);
  if (Interpreted<Real>::now->table.invariant_count > 0) {
    write(functions.values("invariants", z), values);
  }
}

template <class Real>
void gradient(const double* parameters, const double* state, double* values) {
  std::vector<Real> z;
  Interpreter<Real>& functions = functions_with<Real>(parameters, z, state);
  write(functions.values("gradient", z), values);
}

template <class Real>
runtime::LoadedPlugin load(StepCode code, const PluginSource& plugin, int digits) {
  if (Interpreted<Real>::now != nullptr) internal_error("two integrators are interpreted at once");
  auto all = std::make_shared<Interpreted<Real>>();
  all->code = std::move(code);
  all->description = plugin.model.name + ", " + plugin.scheme_name;
  all->solver = plugin.solver;
  all->parameters = all->code.parameters.size();
  for (const Field& field : all->code.record("State")->fields) {
    all->state += static_cast<std::size_t>(field.sizes.empty() ? 1 : field.sizes.front());
  }
  all->table = {HAMGEN_PLUGIN_VERSION,
                static_cast<int>(all->state / 2),
                static_cast<int>(all->parameters),
                static_cast<int>(plugin.invariant_names.size()),
                digits,
                all->description.c_str(),
                all->solver.c_str(),
                create<Real>,
                destroy<Real>,
                advance<Real>,
                get_state<Real>,
                energy<Real>,
                invariants<Real>,
                gradient<Real>,
                nullptr};
  runtime::LoadedPlugin loaded;
  loaded.library = std::make_shared<const runtime::Library>(all->table, all);
  return loaded;
}

}  // namespace

runtime::LoadedPlugin interpreted_integrator(const SourceText& source, const Request& request,
                                             const PluginSource& plugin) {
  StepCode code = make_step_code(source, request);
  const int digits = find_scalar(request.scalar).digits;
  switch (digits) {
    case 24:
      return load<float>(std::move(code), plugin, digits);
    case 64:
      return load<long double>(std::move(code), plugin, digits);
    case 113:
      return load<numerics_of_quad::Real>(std::move(code), plugin, digits);
    default:
      return load<double>(std::move(code), plugin, digits);
  }
}

}  // namespace hamgen::app
