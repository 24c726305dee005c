#include <fmt/format.h>

#include <algorithm>

#include "generator/verify/proof.hpp"

namespace hamgen {

Proof verify(const Mechanics& mechanics, const Scheme& scheme, const Program& program,
             const Expression& hamiltonian) {
  if (std::holds_alternative<Splitting>(scheme.method)) return {prove_splitting_symplectic()};
  if (const auto* tableau = std::get_if<RungeKutta>(&scheme.method)) {
    return {prove_tableau_symplectic(*tableau)};
  }
  const std::optional<int> sweeps = program.plan.sweeps;
  if (const auto* splitting = std::get_if<Splitting>(&scheme.method)) {
    return prove_splitting(*splitting, scheme.order, scheme.needs.find("quadratic") != std::string::npos);
  }
  if (const auto* tableau = std::get_if<RungeKutta>(&scheme.method)) {
    return prove_tableau(*tableau, scheme.order);
  }
  if (const auto* composition = std::get_if<Composition>(&scheme.method)) {
    return prove_composition(*composition, scheme.order);
  }
  const Member& member = scheme.member();
  Proof proof{prove_gauge(member)};
  if (sweeps) {
    // After K sweeps Z is off the solution by O(h^(K+2)), an error no symplectic map needs.
    proof.push_back({"symplectic", Verdict::refuted,
                     fmt::format("{} sweeps leave the step unsolved: the defect M^T J M - J is "
                                 "O(h^{})",
                                 *sweeps, *sweeps + 2)});
    proof.push_back({"symmetric", Verdict::refuted, "the predictor is explicit Euler"});
    proof.push_back(prove_emitted(mechanics, scheme, program, hamiltonian));
    return proof;
  }
  proof.push_back(prove_step_symplectic(member));
  if (std::holds_alternative<Composition>(scheme.method)) {
    proof.back().detail += "; so is each substep, and their composition";
    proof.push_back(prove_symmetric(member));
    proof.back().detail += "; the substeps are the same from both ends";
    return proof;
  }
  proof.push_back(prove_symmetric(member));
  proof.push_back(prove_order(member));
  for (Finding& finding : prove_invariants(mechanics, member)) {
    proof.push_back(std::move(finding));
  }
  proof.push_back(prove_emitted(mechanics, scheme, program, hamiltonian));
  return proof;
}

std::string to_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::proved: return "proved";
    case Verdict::tested: return "tested";
    case Verdict::refuted: return "refuted";
    case Verdict::not_decided: return "not decided";
  }
  return "";
}

std::string to_text(const Proof& proof) {
  std::size_t width = 0;
  for (const Finding& finding : proof) width = std::max(width, finding.property.size());
  std::string text;
  for (const Finding& finding : proof) {
    text += fmt::format("{:{}}  {:11}  {}\n", finding.property, width, to_text(finding.verdict),
                        finding.detail);
  }
  return text;
}

}  // namespace hamgen
