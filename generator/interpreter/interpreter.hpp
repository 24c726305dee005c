// Runs a program without a compiler: the same routines, the same numerics, the same rounding, at
// some tens to hundreds of the time.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "generator/interpreter/machine.hpp"

namespace hamgen {

template <class Real>
class Interpreter {
 public:
  // parameters in the order of the record Parameters; state: 2n numbers, q then p.
  Interpreter(Program code, std::vector<Real> parameters, Real h, const std::vector<Real>& state);

  struct Report {
    bool converged = false;
    long long iterations = 0;
    Real increment = 0;  // on failure, as of StepReport
  };
  // One step; on failure the state stays as it was.
  Report step();

  // A step is all of its substeps, one after the other; of a method that is no composition one.
  [[nodiscard]] std::size_t substeps() const { return substeps_.size(); }
  [[nodiscard]] Real length(std::size_t substep) const { return substeps_.at(substep).h; }
  Report substep(std::size_t i);
  // An array that a substep remembers, a field of Start; empty if there is none of this name.
  [[nodiscard]] std::vector<Real> remembered(std::size_t substep, const std::string& field) const;

  [[nodiscard]] const std::vector<Real>& state() const { return z_.numbers; }
  [[nodiscard]] const std::vector<Real>& carry() const { return carry_.numbers; }
  // Goes on from this state, with nothing known from earlier steps.
  void reset(const std::vector<Real>& state, const std::vector<Real>& carry);

  // H at a state.
  [[nodiscard]] Real energy(const std::vector<Real>& state);
  // A routine that fills in values: "gradient", "invariants", "modified_energies".
  [[nodiscard]] std::vector<Real> values(const std::string& routine,
                                         const std::vector<Real>& state);
  // For the two functions above; the steps keep those that the run was begun with.
  void evaluate_with(const std::vector<Real>& parameters) { parameters_.numbers = parameters; }

 private:
  struct Substep {
    Real h = 0;
    Object<Real> k;
    Object<Real> start;
    std::unique_ptr<AnyHistory<Real>> history;
  };
  Report solve(Substep& substep, Object<Real>& dz, Object<Real>& rest);
  void forget(Substep& substep);
  [[nodiscard]] Given<Real> given(Object<Real>& object) const {
    return {object.numbers.data(), &object};
  }

  std::unique_ptr<const Program> code_;  // the machines point into it
  typename Machine<Real>::Others machines_;
  Object<Real> parameters_, z_, carry_;
  Real h_ = 0;
  std::vector<Substep> substeps_;
};

}  // namespace hamgen
