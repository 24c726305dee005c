// Properties a user insists on.
#pragma once

#include <stdexcept>
#include <string>

#include "generator/verify/proof.hpp"

namespace hamgen {

// A required property that does not hold, or of which that is not known (exit status 5).
class ProofError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// `list` is "symplectic,symmetric,order:P,conserves:NAME,program,emitted-code", any of these.
// Throws ProofError for the first that is not proved (the last two: proved or tested), UsageError
// for a word that is none of them.
void require(const Proof& proof, const std::string& list);
// Whatever the user wants, code that is not the mathematics is not handed out.
void require_emitted(const Proof& proof);

// The findings in short, by verdict: "symplectic, symmetric, order 2".  Empty if there are none.
[[nodiscard]] std::string properties_with(const Proof& proof, Verdict verdict);

}  // namespace hamgen
