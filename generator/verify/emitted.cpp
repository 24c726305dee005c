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

// dV/dq and dT/dp of a splitting.
Identities half_gradient(const Program& program, const Evaluation& half,
                         std::vector<Expression> expected) {
  Identities identities = identities_of(half, "component of a kick or drift", expected);
  identities.emitted.insert(identities.emitted.begin(), program.coefficients.begin(),
                            program.coefficients.end());
  return identities;
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
  if (scheme.has_member() && !is_raised(scheme)) {
    parts.push_back(step_identities(mechanics, derivatives, scheme.member(), program));
  }
  if (std::holds_alternative<Splitting>(scheme.method)) {
    const auto middle = gradient.begin() + mechanics.degrees_of_freedom;
    parts.push_back(half_gradient(program, program.potential_gradient, {gradient.begin(), middle}));
    parts.push_back(half_gradient(program, program.kinetic_gradient, {middle, gradient.end()}));
  }
  if (!program.hessian_places.empty()) {
    std::vector<Expression> entries;
    for (const auto& [i, j] : program.hessian_places) entries.push_back(derivatives.second(i, j));
    parts.push_back(identities_of(program.hessian, "second derivative", entries));
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
  for (const NamedExpression& invariant : mechanics.invariants)
    invariants.push_back(invariant.value);
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
    return {
        property, Verdict::not_decided,
        "energy and gradient of H: " + to_text(total) +
            "; the step takes K in place of H, whose derivatives are not derived a second time"};
  }
  if (!loops && scheme.is_member()) return {property, total.verdict, to_text(total)};
  // What stands around them is the same text for every model and is not read.
  if (!loops) {
    return {property, Verdict::tested,
            to_text(total) +
                ": H, its derivatives and the step that is composed; the sequence of "
                "substeps or stages around them only by measuring"};
  }
  return {property, Verdict::tested,
          to_text(total) +
              ": the summands of all loops and their derivatives, and that they sum up "
              "to H; the solver around them only by measuring"};
}

}  // namespace hamgen
