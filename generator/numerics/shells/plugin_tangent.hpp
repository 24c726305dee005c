// The step from a state and its derivative, row by row.
int tangent_of(const double* parameters, double h, const double* state, double* new_state,
               double* matrix) {
  const Parameters par = read_parameters(parameters, nullptr);
  const State z = read_state(state, nullptr);
  Propagator propagator(par, static_cast<Real>(h), z);
  if (!propagator.step().converged) return 0;
  State dz = propagator.state();
  for_state(dz, z, [&](int i, Real& x, const Real& start) {
    new_state[i] = static_cast<double>(x);
    x -= start;
  });
  Real m[variables][variables];
  if (!tangent(par, static_cast<Real>(h), z, dz, m)) return 0;
  for (int i = 0; i < variables; ++i) {
    for (int j = 0; j < variables; ++j) matrix[i * variables + j] = static_cast<double>(m[i][j]);
  }
  return 1;
}
