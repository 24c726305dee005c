// On failure the increment says how far the iteration was from its end; it is not finite where the
// step left the domain of H.
struct StepReport {
  bool converged = false;
  long long iterations = 0;
  Real increment = 0;
};
