// The step as a value, which is written, interpreted and proved: records, routines, how a step uses
// them, and what is said of it.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "generator/program/code.hpp"
#include "generator/program/environment.hpp"
#include "generator/program/stage_layout.hpp"
#include "generator/program/step_facts.hpp"
#include "generator/solvers/matrix_storage.hpp"

namespace hamgen {

// A rule of start, and the unknowns it stops: it watches how these move from step to step.
struct RuleOfNewton {
  std::string name;
  int first = 0;
  int count = 0;
};

// An event of the model, which is where its value crosses zero in a direction that counts.
struct EventName {
  std::string name;  // free in C++
  bool rising = true, falling = true;
};

// A step is
//
//   for each substep i:  dz = solve(par, k_i, h_i, z, carry, start_i),  z + carry += dz
//
// (dz + rest where solve has a place for the rest of it; without the carry where sums are plain),
// with k_i = prepare(par, h_i), and start_i what substep i remembers of the step before.
struct Program {
  std::vector<Record> records;           // Parameters, State; Coefficients, Start where they are
  std::vector<Routine> routines;         // in the order in which they use each other
  std::vector<Rational> substeps = {1};  // h_i/h
  int unknowns =
      0;  // of the implicit equations, whose solutions are extrapolated from step to step
  std::vector<RuleOfNewton> rules = {};
  bool unchecked = false;  // no step fails: whether the state is finite is looked at by who steps
  bool retries = false;    // is a step that failed tried again without what start remembers?
  std::optional<ArrayMatrix> matrix = {};  // what "Matrix" stands for
  std::optional<StageLayout> stages = {};  // of an implicit Runge-Kutta method
  std::vector<Place> changed;              // fields of State that a step may change
  std::vector<EventName> events = {};      // in the order of the values of the routine "events"
  Environment environment = {};            // where parameters and state stand
  StepFacts facts = {};

  // Does solve leave what is small of an increment in `rest`?
  [[nodiscard]] bool has_rest() const { return solve_takes("rest"); }
  // Is what rounding takes from the state carried along?
  [[nodiscard]] bool has_carry() const { return solve_takes("carry"); }
  // Null if there is none of this name.
  [[nodiscard]] const Record* record(std::string_view name) const;
  [[nodiscard]] const Routine* routine(std::string_view name) const;

 private:
  [[nodiscard]] bool solve_takes(std::string_view argument) const;
};

// The routine of this name, if there is one, and those that it calls.
[[nodiscard]] std::set<std::string> callees(const Program& code, const std::string& routine);

// The records and routines that a step needs: what `hamgen show --stage program` prints.
[[nodiscard]] std::string to_text(const Program& code);
// The same, and before each line how often it is done and of which terms of H it comes.
[[nodiscard]] std::string text_with_origins(const Program& code,
                                            const std::vector<EnergyTerm>& terms);

}  // namespace hamgen
