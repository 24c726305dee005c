#include <algorithm>
#include <iterator>

#include "generator/verify/corners.hpp"
#include "generator/verify/emitted.hpp"
#include "generator/verify/identities.hpp"
#include "generator/verify/proof.hpp"
#include "generator/verify/swept.hpp"

namespace hamgen {

namespace {

// K stands in for H.
const GeneratingFunction* raised_function(const Scheme& scheme, const SolvePlan& plan) {
  if (!scheme.is_member() || scheme.member().generating_order == 0) return nullptr;
  return &*plan.equations.function;
}

// The step back takes K(zbar, -h): it is the adjoint's only if K is even in h.
Decision decide_even(const GeneratingFunction& function, const Surroundings& around) {
  Decision all{.verdict = Verdict::proved};
  std::vector<Expression> slopes = function.gradient;
  for (const Kernel& kernel : function.kernels) slopes.push_back(kernel.value);
  for (const Expression& slope : slopes) {
    const Expression mirrored = substitute(slope, {{"h", -Expression::symbol("h", kRankOfStep)}});
    if (mirrored == slope) continue;
    const Decision one = decide_equal("grad K(zbar, -h)", mirrored, slope, around);
    all.verdict = both(all.verdict, one.verdict);
    if (!holds(one.verdict)) return one;
  }
  return all;
}

Proof prove_member(const Mechanics& mechanics, const Scheme& scheme, const SolvePlan& plan,
                   const Surroundings& around, const std::optional<Decision>& of_k) {
  const Member& member = scheme.member();
  Proof proof{prove_gauge(member, around)};
  if (plan.sweeps) {
    std::ranges::move(prove_swept(mechanics, member, *plan.sweeps, around),
                      std::back_inserter(proof));
    return proof;
  }
  proof.push_back(prove_step_symplectic(member, mechanics.degrees_of_freedom, around));
  Finding symmetric = prove_symmetric(member, around);
  const GeneratingFunction* function = raised_function(scheme, plan);
  if (function == nullptr) {
    proof.push_back(std::move(symmetric));
    proof.push_back(prove_order(member, around));
    return proof;
  }
  if (holds(symmetric.verdict)) {
    const Decision even = decide_even(*function, around);
    symmetric = resting_on(even.verdict,
                           even.verdict == Verdict::tested
                               ? "K(-h) = K(h) " + points_text(even)
                               : "K is not known to be even in h: " + even.witness,
                           std::move(symmetric));
  }
  proof.push_back(std::move(symmetric));
  proof.push_back(prove_raised_order(*function, *of_k));
  return proof;
}

bool is_solved(const Mechanics& mechanics, const Scheme& scheme, const SolvePlan& plan) {
  if (!plan.sweeps) return true;
  return !mechanics.keeps_sums() &&
         sweeps_solve(mechanics, Derivatives(mechanics), scheme.member(), *plan.sweeps);
}

Proof prove_method(const Mechanics& mechanics, const Scheme& scheme, const SolvePlan& plan,
                   const Surroundings& around, const std::optional<Decision>& of_k) {
  if (const auto* splitting = std::get_if<Splitting>(&scheme.method)) {
    const bool nystrom = scheme.needs.find("quadratic") != std::string::npos;
    return prove_splitting(*splitting, scheme.order, nystrom);
  }
  if (const auto* tableau = std::get_if<RungeKutta>(&scheme.method)) {
    return prove_tableau(*tableau, scheme.order);
  }
  if (const auto* composition = std::get_if<Composition>(&scheme.method)) {
    if (!is_solved(mechanics, scheme, plan))
      return prove_swept(mechanics, scheme.member(), *plan.sweeps, around, composition->substeps);
    return prove_composition(*composition, mechanics.degrees_of_freedom, scheme.order, around);
  }
  return prove_member(mechanics, scheme, plan, around, of_k);
}

Verdict verdict_of(const Proof& proof, const std::string& property) {
  const auto found = std::ranges::find(proof, property, &Finding::property);
  return found == proof.end() ? Verdict::not_decided : found->verdict;
}

}  // namespace

Proof verify(const Mechanics& mechanics, const Scheme& scheme, const SolvePlan& plan,
             const Program& program, const std::optional<Expression>& hamiltonian,
             const Surroundings& around, const std::optional<SmallerSystems>& smaller) {
  std::optional<Decision> of_k;
  if (raised_function(scheme, plan) != nullptr)
    of_k = decide_raised(mechanics, plan, program, hamiltonian, around, smaller);
  Proof proof = prove_method(mechanics, scheme, plan, around, of_k);
  // A step is what it is proved to be where H has the derivatives it is made of.
  const std::vector<Corner> corners_of_h = corners_of_hamiltonian(mechanics);
  if (!corners_of_h.empty()) {
    for (Finding& finding : proof) {
      if (finding.property != kGauge)
        finding = resting_on(Verdict::tested, off_the(corners_of_h), std::move(finding));
    }
  }
  if (hamiltonian || says_nothing_of_invariants(mechanics)) {
    std::ranges::move(prove_invariants(mechanics, hamiltonian.value_or(Expression(0)), scheme,
                                       is_solved(mechanics, scheme, plan),
                                       verdict_of(proof, "symplectic"), around),
                      std::back_inserter(proof));
  }
  proof.push_back(
      prove_emitted(mechanics, scheme, plan, program, hamiltonian, around, of_k, smaller));
  return proof;
}

}  // namespace hamgen
