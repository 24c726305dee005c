// How orbits near one another part: indicators of chaos from the step's own tangent map.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "app/studies/stop.hpp"
#include "runtime/integrator.hpp"

namespace hamgen::app {

struct ChaosRequest {
  std::shared_ptr<const runtime::Library> library;  // with its tangent map
  runtime::InitialValues start;
  long steps = 0;
  bool spectrum = false;  // all Lyapunov exponents: as many deviations as the state has components
  int deviations = 2;     // of GALI, at least 2; with the spectrum all
  std::function<void(long steps)> on_progress = {};
  StopFlag stop = nullptr;
};

// At one time.  Exponents are in units of 1/time.  Deviations have lengths in the natural sizes of
// their components (natural_sizes.hpp): meters and kilograms do not decide what is long.
struct ChaosSample {
  double time = 0.0;
  // ln(|w(t)|/|w(0)|)/t of a deviation w: goes to the largest Lyapunov exponent.
  double lyapunov = 0.0;
  // The mean over time of (2/t) times the integral of (|w|'/|w|) t': 2 on quasi-periodic orbits,
  // 0 where frequencies do not depend on amplitudes, growing by lyapunov t/2 on chaotic ones.
  //   P. M. Cincotta, C. Simo: Simple tools to study global dynamics in non-axisymmetric galactic
  //   potentials I, Astron. Astrophys. Suppl. Ser. 147 (2000) 205.
  double megno = 0.0;
  // The largest ln|w(t')| so far.
  //   C. Froeschle, E. Lega, R. Gonczi: Fast Lyapunov indicators, Celest. Mech. Dyn. Astron. 67
  //   (1997) 41.
  double fli = 0.0;
  // The smaller of |a - b| and |a + b| of two deviations of length 1: to 0 exponentially on chaotic
  // orbits.
  //   C. Skokos: Alignment indices, J. Phys. A 34 (2001) 10029.
  double sali = 0.0;
  // The volume that all deviations, of length 1, span: GALI_k of k deviations.
  //   C. Skokos, T. Bountis, C. Antonopoulos: Geometrical properties of local dynamics in
  //   Hamiltonian systems: the generalized alignment index method, Physica D 231 (2007) 30.
  double gali = 0.0;
};

struct Chaos {
  runtime::Status status = runtime::Status::done;
  long steps = 0;
  double largest_energy_error = 0.0;  // after every step
  double energy_scale = 0.0;          // see runtime::Judge::energy_terms
  std::vector<ChaosSample> samples;   // the last one at the end; times grow by about a tenth
  std::vector<double> spectrum;       // exponents, the largest first; empty if not asked for
  int deviations = 0;
};

// Throws std::invalid_argument if the plugin has no tangent map.
[[nodiscard]] Chaos chaos(const ChaosRequest& request);

}  // namespace hamgen::app
