// What the claims about the methods have in common.
#pragma once

#include <string>

#include "generator/equations/step_equations.hpp"
#include "generator/verify/emitted.hpp"

namespace hamgen {

// Numbers of a method are roots or zeros of polynomials, given by 70 digits: 60 of them make a
// number the exact one.
inline Expression recognised(const Expression& emitted, const Expression& exact) {
  if (!emitted.is_number()) return emitted;
  Rational difference = emitted.number() - numeric_value(exact);
  if (difference < 0) difference = -difference;
  Integer digits;
  mpz_ui_pow_ui(digits.get_mpz_t(), 10, 60);
  return difference * Rational(digits) < 1 ? exact : emitted;
}

// Claims about one run of the routines, while they are put together.
class Claims {
 public:
  explicit Claims(const StepUnderProof& step, std::set<std::string> opaque = {})
      : machine_(step.machine(std::move(opaque))) {}

  void add(std::string what, const Expression& emitted, const Expression& expected) {
    identities_.claims.push_back({std::move(what), emitted, expected});
  }
  void add_number(std::string what, const Expression& emitted, const Expression& exact) {
    add(std::move(what), recognised(emitted, exact), exact);
  }
  void add_count(std::string what, std::size_t emitted, std::size_t expected) {
    add(std::move(what), Expression(static_cast<long>(emitted)),
        Expression(static_cast<long>(expected)));
  }
  [[nodiscard]] SymbolicMachine& machine() { return machine_; }
  Identities take() {
    identities_.emitted = machine_.definitions();
    return std::move(identities_);
  }

 private:
  SymbolicMachine machine_;
  Identities identities_;
};

// Definitions in terms of what is free.
inline Substitution meaning_of(const SymbolicMachine& machine) {
  Substitution meaning;
  for (const Statement& s : machine.definitions()) meaning[s.name] = substitute(s.value, meaning);
  return meaning;
}
inline Expression written_out(const SymbolicMachine& machine, const Expression& e) {
  return substitute(e, meaning_of(machine));
}

inline Place of_k(const std::string& field, long i) { return {"k", field, {{i, {}}}}; }
inline Place of_start(const std::string& field, long i) { return {"start", field, {{i, {}}}}; }

}  // namespace hamgen
