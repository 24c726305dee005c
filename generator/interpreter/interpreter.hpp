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
  Interpreter(const Interpreter&) = delete;  // its machines point into it
  Interpreter& operator=(const Interpreter&) = delete;

  struct Report {
    bool converged = false;
    long long iterations = 0;
    Real increment = 0;  // on failure, as of StepReport
  };
  // One step; on failure the state stays as it was.
  Report step();

  // A step is all of its substeps, one after the other; of a method that is no composition one.
  [[nodiscard]] std::size_t substeps() const { return code_->substeps.size(); }
  [[nodiscard]] Real length(std::size_t substep) const;
  Report substep(std::size_t i);
  // An array that a substep remembers, a field of Start; empty if there is none of this name.
  [[nodiscard]] std::vector<Real> remembered(std::size_t substep, const std::string& field) const;

  [[nodiscard]] const std::vector<Real>& state() const { return kept("z").numbers; }
  [[nodiscard]] const std::vector<Real>& carry() const { return kept("carry").numbers; }
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
  [[nodiscard]] Object<Real>& kept(const std::string& field, std::size_t substep = 0) {
    return memory_.fields.at(field).at(substep);
  }
  [[nodiscard]] const Object<Real>& kept(const std::string& field) const {
    return memory_.fields.at(field).front();
  }
  void forget();
  Report run(const std::string& routine, const std::vector<Given<Real>>& arguments);
  [[nodiscard]] Given<Real> given(Object<Real>& object) const {
    return {object.numbers.data(), &object};
  }

  std::unique_ptr<const Program> code_;  // the machines point into it
  typename Machine<Real>::Others machines_;
  Object<Real> parameters_;
  Real h_ = 0;
  RunMemory<Real> memory_;
};

}  // namespace hamgen
