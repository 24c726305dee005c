// Properties a user insists on.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "generator/verify/proof.hpp"

namespace hamgen {

// A required property that does not hold, or of which that is not known (exit status 5).
class ProofError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Requirement {
  std::string word;      // as it was typed
  std::string property;  // of a finding; empty: that of the order
  int order = 0;
  std::string invariant = {};  // that is to be conserved
  bool may_be_tested = false;  // is that enough?
};

// "symplectic,symmetric,order:P,conserves:NAME,program,emitted-code", any of these.
struct Requirements {
  std::vector<Requirement> list;
  // Throws UsageError for a word that is none of them.
  [[nodiscard]] static Requirements read(const std::string& text);
};

// Throws ProofError for the first that is not proved (the last two: proved or tested), UsageError
// for an invariant that the model has not.
void require(const Proof& proof, const Requirements& required);
// Whatever the user wants, code that is not the mathematics is not handed out.
void require_emitted(const Proof& proof);

// The findings in short, by verdict: "symplectic, symmetric, order 2".  Empty if there are none.
[[nodiscard]] std::string properties_with(const Proof& proof, Verdict verdict);

}  // namespace hamgen
