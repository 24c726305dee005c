/* The pendulum by Stormer-Verlet, in C. */
#include "pendulum.h"

#include <stdio.h>

int main(void) {
  const pendulum_Parameters par = pendulum_default_parameters();
  const pendulum_State start = {3.1, 0.0};
  pendulum_stormer_verlet_Propagator run =
      pendulum_stormer_verlet_Propagator_make(&par, 0.1, &start);
  if (!pendulum_stormer_verlet_Propagator_advance(&run, 1000).converged) return 1;
  printf("%.15g %.15g\n", run.z.q, run.z.p);
  return 0;
}
