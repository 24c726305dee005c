// On failure the increment says how far the iteration was from its end; it is not finite where the
// step left the domain of H.
typedef struct {
  bool converged;
  long long iterations;
  Real increment;
} StepReport;
