// How well a statement is known, and what that makes of the statements that rest on it.
#pragma once

#include <string>
#include <vector>

namespace hamgen {

// `proved`: by exact algebra.  `tested`: no counterexample at many points, or by arithmetic that
// rounds, which is less than a proof.  `refuted`: there is a counterexample.  `measured`: a number,
// without a claim.
enum class Verdict { proved, tested, refuted, not_decided, measured };

// Of a statement that says two things: refuted if one of them is, else known as well as the lesser.
[[nodiscard]] Verdict both(Verdict a, Verdict b);
// Of a conclusion: no better known than its premise, and open where the premise does not hold.
[[nodiscard]] Verdict resting_on(Verdict premise, Verdict conclusion);
// Is there a reason to believe it?
[[nodiscard]] bool holds(Verdict verdict);

struct Finding {
  std::string property;  // "symplectic"
  Verdict verdict = Verdict::not_decided;
  // How, or the failing entry with its value, or why it is open.  Formulas stand between grave
  // accents, for pages to set as formulas; `plain` is without these marks.
  std::string detail;
  [[nodiscard]] std::string plain() const;
};
// The finding of a conclusion; `why` is added if the premise is less than proved.
[[nodiscard]] Finding resting_on(Verdict premise, const std::string& why, Finding conclusion);

using Proof = std::vector<Finding>;

[[nodiscard]] std::string to_text(Verdict verdict);
[[nodiscard]] std::string to_text(const Proof& proof);

}  // namespace hamgen
