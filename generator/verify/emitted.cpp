#include "generator/verify/emitted.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/verify/expected_step.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {

namespace {

bool is_raised(const Scheme& scheme) {
  return scheme.is_member() && scheme.member().generating_order > 0;
}

std::vector<Identities> straight_line_identities(const Mechanics& mechanics, const Scheme& scheme,
                                                 const Program& program) {
  const Derivatives derivatives(mechanics);
  std::vector<Expression> gradient;
  for (int i = 0; i < 2 * mechanics.degrees_of_freedom; ++i) {
    gradient.push_back(derivatives.first(i));
  }
  std::vector<Identities> parts = {
      identities_of(program.energy, "the energy", {mechanics.energy}),
      identities_of(program.gradient, "component of the gradient", gradient)};
  if (!is_raised(scheme)) {
    parts.push_back(step_identities(mechanics, derivatives, scheme.member(), program));
  }
  return parts;
}

}  // namespace

Identities identities_of(const Evaluation& evaluation, const std::string& what,
                         const std::vector<Expression>& expected) {
  Identities identities{.emitted = evaluation.statements};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    identities.claims.push_back({expected.size() == 1 ? what : fmt::format("{} {}", what, i + 1),
                                 evaluation.results.at(i), expected[i]});
  }
  return identities;
}

Finding prove_emitted(const Mechanics& mechanics, const Scheme& scheme, const Program& program,
                      const Expression& hamiltonian) {
  const std::string property = "emitted code";
  const bool loops = mechanics.keeps_sums();
  std::vector<Identities> parts = loops ? kernel_identities(mechanics, hamiltonian)
                                        : straight_line_identities(mechanics, scheme, program);
  std::vector<Expression> invariants;
  for (const NamedExpression& invariant : mechanics.invariants) invariants.push_back(invariant.value);
  parts.push_back(identities_of(program.invariants, "invariant", invariants));
  Decision total{.verdict = Verdict::proved};
  for (const Identities& part : parts) {
    const Decision decision = decide(part);
    total.claims += decision.claims;
    total.by_algebra += decision.by_algebra;
    total.points = std::max(total.points, decision.points);
    if (decision.verdict == Verdict::proved) continue;
    total.verdict = decision.verdict;
    if (decision.verdict == Verdict::tested) continue;
    return {property, decision.verdict, decision.witness};
  }
  if (is_raised(scheme)) {
    return {property, Verdict::not_decided,
            "energy and gradient of H: " + to_text(total) +
                "; the step takes K in place of H, whose derivatives are not derived a second time"};
  }
  if (!loops) return {property, total.verdict, to_text(total)};
  // The loops around the summands are the same text for every model and are not read.
  return {property, Verdict::tested,
          to_text(total) + ": the summands of all loops and their derivatives, and that they sum up "
                           "to H; the solver around them only by measuring"};
}

}  // namespace hamgen
