// Which place of the host's arrays is which parameter and which part of the state stands above; the
// rest of the interface is the same in every plugin.

// The double nearest to the value; what it leaves of it is lo.
double high_part(Real value, double* lo) {
  const double hi = static_cast<double>(value);
  if (lo) *lo = static_cast<double>(value - static_cast<Real>(hi));
  return hi;
}

// What hi + lo leave of a state's value, and what rounding took from it.
Real carried(Real value, Real carry) {
  double lo;
  const double hi = high_part(value, &lo);
  return (value - static_cast<Real>(hi) - static_cast<Real>(lo)) + carry;
}

// Element i of an array of the host; of two where a double does not hold the number.
Real element(const double* hi, const double* lo, int i) {
  const Real value = static_cast<Real>(hi[i]);
  return lo && sizeof(Real) > sizeof(double) ? value + static_cast<Real>(lo[i]) : value;
}

// Its place in an array that may not be there.
double* element(double* lo, int i) { return lo ? lo + i : nullptr; }

Parameters read_parameters(const double* parameters, const double* parameters_lo) {
  Parameters par;
  for_parameters(par, [&](int i, Real& x) { x = element(parameters, parameters_lo, i); });
  return par;
}

void give_parameters(const Parameters& par, double* parameters, double* parameters_lo) {
  for_parameters(
      par, [&](int i, const Real& x) { parameters[i] = high_part(x, element(parameters_lo, i)); });
}

State read_state(const double* state, const double* state_lo) {
  State z;
  for_state(z, z, [&](int i, Real& x, const Real&) { x = element(state, state_lo, i); });
  return z;
}

hamgen_run* create(const double* parameters, const double* parameters_lo, double h, double h_lo,
                   const double* state, const double* state_lo) {
  void* const memory = __builtin_malloc(sizeof(hamgen_run));
  if (!memory) return nullptr;
  return new (hamgen_place{memory}) hamgen_run{
      Propagator(read_parameters(parameters, parameters_lo),
                 static_cast<Real>(h) + static_cast<Real>(h_lo), read_state(state, state_lo)),
      0};
}

void destroy(hamgen_run* run) {
  if (!run) return;
  run->~hamgen_run();
  __builtin_free(run);
}

void advance(hamgen_run* run, long long steps, int watch_energy, hamgen_report* report) {
  hamgen_report total{};
  Real energy_min{}, energy_max{}, energy_last{};
  for (long long i = 0; i < steps; ++i) {
    const StepReport last = run->propagator.step();
    total.last_iterations = static_cast<int>(last.iterations);
    total.last_increment = static_cast<double>(last.increment);
    if (!last.converged) {
      const bool finite = total.last_increment - total.last_increment == 0.0;
      total.status = finite ? HAMGEN_NOT_CONVERGED : HAMGEN_NOT_FINITE;
      break;
    }
    total.iterations += last.iterations;
    ++total.steps_done;
    if (watch_energy) {
      energy_last = energy(run->propagator.parameters(), run->propagator.state());
      if (i == 0 || energy_last < energy_min) energy_min = energy_last;
      if (i == 0 || energy_last > energy_max) energy_max = energy_last;
      const double now = static_cast<double>(energy_last);
      if (!(now - now == 0.0)) {
        total.status = HAMGEN_NOT_FINITE;
        break;
      }
    }
  }
  // Where no step fails, numbers may end all the same.
  const bool ends = never_fails && !run->propagator.advance(0).converged;
  if (total.status == HAMGEN_DONE && ends) total.status = HAMGEN_NOT_FINITE;
  total.energy_min = high_part(energy_min, &total.energy_min_lo);
  total.energy_max = high_part(energy_max, &total.energy_max_lo);
  total.energy_last = high_part(energy_last, &total.energy_last_lo);
  *report = total;
}

void get_state(const hamgen_run* run, double* state, double* state_lo) {
  const State& z = run->propagator.state();
  for_state(z, z, [&](int i, const Real& x, const Real&) {
    state[i] = high_part(x, element(state_lo, i));
  });
}

void get_carry(const hamgen_run* run, double* carry, double* carry_lo) {
  for_state(run->propagator.state(), carry_of(run->propagator),
            [&](int i, const Real& x, const Real& c) {
              carry[i] = high_part(carried(x, c), element(carry_lo, i));
            });
}

// All that the run is, as bytes; with matrices of Eigen it is more than these.
long long save_run(const hamgen_run* run, void* bytes) {
  if (!__is_trivially_copyable(hamgen_run)) return 0;
  if (bytes) __builtin_memcpy(bytes, run, sizeof *run);
  return static_cast<long long>(sizeof *run);
}

int restore_run(hamgen_run* run, const void* bytes, long long size) {
  if (size == 0 || size != save_run(run, nullptr)) return 0;
  __builtin_memcpy(static_cast<void*>(run), bytes, sizeof *run);
  return 1;
}

double energy_of(const double* parameters, const double* parameters_lo, const double* state,
                 const double* state_lo, double* energy_lo) {
  return high_part(energy(read_parameters(parameters, parameters_lo), read_state(state, state_lo)),
                   energy_lo);
}

void invariants_of(const double* parameters, const double* parameters_lo, const double* state,
                   const double* state_lo, double* values, double* values_lo) {
  for_invariants(read_parameters(parameters, parameters_lo), read_state(state, state_lo),
                 [&](int i, const Real& x) { values[i] = high_part(x, element(values_lo, i)); });
}

void gradient_of(const double* parameters, const double* state, double* values) {
  for_gradient(read_parameters(parameters, nullptr), read_state(state, nullptr),
               [&](int i, const Real& x) { values[i] = static_cast<double>(x); });
}

void default_parameters(double* parameters, double* parameters_lo) {
  give_parameters(Parameters(), parameters, parameters_lo);
}

Real time_of(const hamgen_run* run) { return run->start_time + run->propagator.time(); }

double get_time(const hamgen_run* run, double* t_lo) { return high_part(time_of(run), t_lo); }

double get_h(const hamgen_run* run, double* h_lo) { return high_part(run->propagator.h(), h_lo); }

void get_parameters(const hamgen_run* run, double* parameters, double* parameters_lo) {
  give_parameters(run->propagator.parameters(), parameters, parameters_lo);
}

// The propagator's time is none behind its start, or the state's own.
void set_time(hamgen_run* run, Real t) { run->start_time = t - run->propagator.time(); }

void set_state(hamgen_run* run, double t, double t_lo, const double* state,
               const double* state_lo) {
  run->propagator.reset(read_state(state, state_lo));
  set_time(run, static_cast<Real>(t) + static_cast<Real>(t_lo));
}

void go_on_with(hamgen_run* run, const Parameters& par, Real h) {
  const Real t = time_of(run);
  const State z = run->propagator.state();
  run->propagator.~Propagator();
  new (hamgen_place{&run->propagator}) Propagator(par, h, z);
  set_time(run, t);
}

void set_h(hamgen_run* run, double h, double h_lo) {
  const Parameters par = run->propagator.parameters();
  go_on_with(run, par, static_cast<Real>(h) + static_cast<Real>(h_lo));
}

void set_parameters(hamgen_run* run, const double* parameters, const double* parameters_lo) {
  go_on_with(run, read_parameters(parameters, parameters_lo), run->propagator.h());
}
