// The solution of a Hamiltonian system to many digits, by extrapolation: what the errors
// of all other integrations are measured against.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/integrator.hpp"

namespace hamgen::runtime {

struct ExtrapolationOptions {
  double tolerance = 1e-28;                      // of one extrapolated step, relative to the state
  int first_parts = 64;                          // the first step is the time divided by this
  std::function<void(double)> on_progress = {};  // the fraction of the time that is done
  const std::atomic<bool>* stop = nullptr;
};

struct Extrapolation {
  std::vector<Wide> state;  // at the end: q then p
  std::string failure;      // why the end was not reached; empty if it was
  double reached = 0.0;     // the time of `state`
  long long steps = 0;      // extrapolated ones
  long long solves = 0;     // steps of the rule in all
};

// The state after `time` (negative: before).  `library` must be a symmetric rule of order 2 (the
// implicit midpoint, Stormer-Verlet) compiled for quad numbers; start.h is not used.
//
// Source: E. Hairer, S. P. Norsett, G. Wanner: Solving Ordinary Differential Equations I, 2nd ed.,
// II.9.  A step of size H is taken with 1, 2, 3, ... steps of the rule; the results T_1, T_2, ...
// have an expansion in (H/j)^2, because the rule is symmetric, and Aitken and Neville's scheme
// removes its terms one by one until two columns agree to the tolerance.  H follows the number of
// rows that took.
[[nodiscard]] Extrapolation extrapolate(const std::shared_ptr<const Library>& library,
                                        const InitialValues& start, Wide time,
                                        const ExtrapolationOptions& options = {});

}  // namespace hamgen::runtime
