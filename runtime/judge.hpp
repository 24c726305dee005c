// What an orbit is judged by: the sizes and energies it begins with.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/library.hpp"
#include "runtime/status.hpp"

namespace hamgen::runtime {

// Tells a step that failed from one that escaped, and an error from a jump, in units of the start.
class Judge {
 public:
  // Of the orbit that begins at `state` (2n values: q then p).  `defined_everywhere`: H and its
  // gradient are, so that what is not finite is an overflow.
  Judge(std::shared_ptr<const Library> library, std::span<const Wide> parameters,
        std::span<const Wide> state, bool defined_everywhere);

  // H at the start.
  [[nodiscard]] Wide energy() const { return energy_; }
  // The larger of |H| and |q| |H_q| + |p| |H_p| at the start, energies both, whatever the units of
  // q and p: what a jump is measured by, even if H happens to vanish there.
  [[nodiscard]] double energy_scale() const { return energy_scale_; }
  // The largest of |H|, terms() and |q H_q|/2 at the start, energies all of them, whatever the
  // units of q and p: what a person compares an energy error with.
  [[nodiscard]] double energy_terms() const { return energy_terms_; }
  // How large the components of a state are, but for the time of a driven system.  The unit is the
  // largest at the start, or 1; for momenta also that of a mass of 1 that has all the energy of the
  // scale as kinetic energy.
  [[nodiscard]] double size_of(std::span<const double> state) const;

  // Ten energy scales.
  [[nodiscard]] double jump_limit() const;
  // Is an error |H - H(0)| larger than that limit?
  [[nodiscard]] bool is_jump(double energy_error) const { return energy_error > jump_limit(); }
  // The limit from there on of an orbit whose terms of H at that state explain an error beyond the
  // one it had; empty where they do not.  See Note [jumps] in trajectory.cpp.
  [[nodiscard]] std::optional<double> raised_limit(double limit, std::span<const double> state,
                                                   double energy_error) const;
  // The error is small beside |p H_p|/2 or |q H_q|/2 at the state.  A step that is unstable on a
  // quadratic H errs by their sum.
  [[nodiscard]] bool keeps_energy(std::span<const double> state, double energy_error) const;
  // The larger of |p H_p|/2 and |H - p H_p/2| at the state: of a mechanical system, of the kinetic
  // and the potential energy.
  [[nodiscard]] double terms(std::span<const double> state) const;

  // What a step that failed for this reason is called, where the last good state and the largest
  // energy error so far are these: Status::not_converged, left_domain or jumped may be an escape,
  // the first two an overflow.
  [[nodiscard]] Status failure(Status reason, std::span<const double> state,
                               double energy_error) const;

 private:
  [[nodiscard]] std::vector<double> without_clocks(std::span<const double> state) const;

  std::shared_ptr<const Library> library_;
  std::vector<double> parameters_;  // rounded: what follows are sizes, not results
  bool defined_everywhere_;
  Wide energy_;
  double energy_scale_;
  double energy_terms_;
  std::vector<std::size_t> clocks_;  // coordinates that are the time
  double q_size_;
  double p_size_;
};

}  // namespace hamgen::runtime
