#include "app/studies/interpreted.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "generator/algebra/scalar.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/interpreter/interpreter.hpp"

namespace hamgen::app {

namespace {

// The functions of the interface have no place for what they belong to: it is here.
template <class Real>
struct Interpreted {
  Program code;
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

// The double nearest to the value; what it leaves of it is low.
template <class Real>
double high_part(Real value, double* low) {
  const auto high = static_cast<double>(value);
  if (low != nullptr) *low = static_cast<double>(value - static_cast<Real>(high));
  return high;
}

template <class Real>
void write(const std::vector<Real>& numbers, double* values, double* low) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    values[i] = high_part(numbers[i], low != nullptr ? low + i : nullptr);
}

// As the compiled one does it.
template <class Real>
void advance(hamgen_run* run, long long steps, int watch_energy, hamgen_report* report) {
  Interpreter<Real>& interpreter = interpreter_of<Real>(run);
  *report = {};
  Real min{}, max{}, now{};
  const auto tell_energies = [&] {
    report->energy_min = high_part(min, &report->energy_min_lo);
    report->energy_max = high_part(max, &report->energy_max_lo);
    report->energy_last = high_part(now, &report->energy_last_lo);
  };
  for (long long i = 0; i < steps && report->status == HAMGEN_DONE; ++i) {
    const auto last = interpreter.step();
    report->last_iterations = static_cast<int>(last.iterations);
    report->last_increment = static_cast<double>(last.increment);
    if (!last.converged) {
      report->status =
          std::isfinite(report->last_increment) ? HAMGEN_NOT_CONVERGED : HAMGEN_NOT_FINITE;
      break;
    }
    ++report->steps_done;
    report->iterations += last.iterations;
    if (watch_energy == 0) continue;
    now = interpreter.energy(interpreter.state());
    if (i == 0 || now < min) min = now;
    if (i == 0 || now > max) max = now;
    if (!std::isfinite(static_cast<double>(now))) report->status = HAMGEN_NOT_FINITE;
  }
  tell_energies();
}

template <class Real>
void get_state(const hamgen_run* run, double* state, double* low) {
  write(interpreter_of<Real>(run).state(), state, low);
}

template <class Real>
void get_carry(const hamgen_run* run, double* carry, double* low) {
  std::vector<Real> rest = interpreter_of<Real>(run).state();
  for (std::size_t i = 0; i < rest.size(); ++i) {
    double lo = 0.0;
    const double hi = high_part(rest[i], &lo);
    rest[i] = (rest[i] - static_cast<Real>(hi) - static_cast<Real>(lo)) +
              interpreter_of<Real>(run).carry()[i];
  }
  write(rest, carry, low);
}

template <class Real>
Interpreter<Real>& functions_with(const double* parameters, const double* parameters_low,
                                  std::vector<Real>& state, const double* values,
                                  const double* values_low) {
  Interpreted<Real>& now = *Interpreted<Real>::now;
  const std::vector<Real> par = read<Real>(parameters, parameters_low, now.parameters);
  state = read<Real>(values, values_low, now.state);
  if (!now.functions) {
    now.functions = std::make_unique<Interpreter<Real>>(now.code, par, Real(1), state);
  }
  now.functions->evaluate_with(par);
  return *now.functions;
}

template <class Real>
double energy(const double* parameters, const double* parameters_low, const double* state,
              const double* state_low, double* low) {
  std::vector<Real> z;
  Interpreter<Real>& functions =
      functions_with<Real>(parameters, parameters_low, z, state, state_low);
  return high_part(functions.energy(z), low);
}

template <class Real>
void invariants(const double* parameters, const double* parameters_low, const double* state,
                const double* state_low, double* values, double* low) {
  std::vector<Real> z;
  Interpreter<Real>& functions =
      functions_with<Real>(parameters, parameters_low, z, state, state_low);
  if (Interpreted<Real>::now->table.invariant_count > 0) {
    write(functions.values("invariants", z), values, low);
  }
}

template <class Real>
void gradient(const double* parameters, const double* state, double* values) {
  std::vector<Real> z;
  Interpreter<Real>& functions = functions_with<Real>(parameters, nullptr, z, state, nullptr);
  write(functions.values("gradient", z), values, nullptr);
}

template <class Real>
runtime::LoadedPlugin load(Program code, const PluginSource& plugin, int digits) {
  if (Interpreted<Real>::now != nullptr) internal_error("two integrators are interpreted at once");
  auto all = std::make_shared<Interpreted<Real>>();
  all->code = std::move(code);
  all->description = plugin.model.name + ", " + plugin.scheme_name;
  all->solver = plugin.solver;
  all->parameters = all->code.environment.parameters.size();
  for (const Field& field : all->code.record("State")->fields) {
    all->state += static_cast<std::size_t>(field.sizes.empty() ? 1 : field.sizes.front());
  }
  // What the numbers are, and setters, are left out: whoever interprets has the model.
  all->table = {.version = HAMGEN_PLUGIN_VERSION,
                .degrees_of_freedom = static_cast<int>(all->state / 2),
                .parameter_count = static_cast<int>(all->parameters),
                .invariant_count = static_cast<int>(plugin.invariant_names.size()),
                .scalar_digits = digits,
                .description = all->description.c_str(),
                .solver = all->solver.c_str(),
                .create = create<Real>,
                .destroy = destroy<Real>,
                .advance = advance<Real>,
                .get_state = get_state<Real>,
                .get_carry = get_carry<Real>,
                .energy = energy<Real>,
                .invariants = invariants<Real>,
                .gradient = gradient<Real>};
  runtime::LoadedPlugin loaded;
  loaded.library = std::make_shared<const runtime::Library>(all->table, all);
  return loaded;
}

}  // namespace

runtime::LoadedPlugin interpreted_integrator(const SourceText& source, const Request& request,
                                             const PluginSource& plugin) {
  Program code = make_program(source, request);
  const int digits = request.scalar->type->digits;
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
