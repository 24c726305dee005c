#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "generator/verify/proof.hpp"

namespace hamgen {

namespace {

Proof prove_member(const Mechanics& mechanics, const Member& member, std::optional<int> sweeps) {
  Proof proof{prove_gauge(member)};
  if (sweeps) {
    proof.push_back(prove_swept(mechanics, member, *sweeps));
    proof.push_back({"symmetric", Verdict::refuted, "the predictor is explicit Euler"});
    return proof;
  }
  proof.push_back(prove_step_symplectic(member));
  proof.push_back(prove_symmetric(member));
  proof.push_back(prove_order(member));
  return proof;
}

Proof prove_method(const Mechanics& mechanics, const Scheme& scheme, std::optional<int> sweeps) {
  if (const auto* splitting = std::get_if<Splitting>(&scheme.method)) {
    const bool nystrom = scheme.needs.find("quadratic") != std::string::npos;
    return prove_splitting(*splitting, scheme.order, nystrom);
  }
  if (const auto* tableau = std::get_if<RungeKutta>(&scheme.method)) {
    return prove_tableau(*tableau, scheme.order);
  }
  if (const auto* composition = std::get_if<Composition>(&scheme.method)) {
    return prove_composition(*composition, scheme.order);
  }
  return prove_member(mechanics, scheme.member(), sweeps);
}

}  // namespace

Proof verify(const Mechanics& mechanics, const Scheme& scheme, const Program& program,
             const Expression& hamiltonian) {
  Proof proof = prove_method(mechanics, scheme, program.plan.sweeps);
  const bool swept = program.plan.sweeps.has_value();
  std::ranges::move(prove_invariants(mechanics, hamiltonian, scheme, swept),
                    std::back_inserter(proof));
  proof.push_back(prove_emitted(mechanics, scheme, program, hamiltonian));
  return proof;
}

std::string to_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::proved:
      return "proved";
    case Verdict::tested:
      return "tested";
    case Verdict::refuted:
      return "refuted";
    case Verdict::not_decided:
      return "not decided";
    case Verdict::measured:
      return "measured";
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
