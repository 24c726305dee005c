// A step whose routines are compared with the mathematics.
#pragma once

#include "generator/program/environment.hpp"
#include "generator/program/program.hpp"
#include "generator/schemes/scheme.hpp"
#include "generator/verify/symbolic_machine.hpp"

namespace hamgen {

struct StepUnderProof {
  StepUnderProof(const Mechanics& of, const Scheme& by, const Program& routines)
      : mechanics(of), scheme(by), code(routines), environment(routines.environment) {}

  const Mechanics& mechanics;
  const Scheme& scheme;
  const Program& code;
  const Environment& environment;

  [[nodiscard]] int size() const { return 2 * mechanics.degrees_of_freedom; }
  [[nodiscard]] std::string name(int i) const {
    return mechanics.variables.name(static_cast<std::size_t>(i));
  }
  // 0 where sums are plain.
  [[nodiscard]] Expression carry(int i) const {
    if (!code.has_carry()) return Expression(0);
    return Expression::symbol("carry(" + name(i) + ")", kRankOfVariable + i);
  }
  // With z, the carry and the parameters where the routines look for them, and no step yet.
  [[nodiscard]] SymbolicMachine machine(std::set<std::string> opaque = {}) const;
  // Component i of what a routine is given: of a state, or of an array that begins at `first`.
  [[nodiscard]] Expression component(const std::vector<Expression>& input, int i, int first) const;
  // dz + rest, what is small of it included.
  [[nodiscard]] Expression increment(SymbolicMachine& machine, int i) const;
};

}  // namespace hamgen
