// The substeps and the tableau that are written, against those of the scheme.
#include <fmt/format.h>

#include "generator/verify/emitted.hpp"

namespace hamgen {

namespace {

Expression symbol_of(SubstepKind kind) {
  switch (kind) {
    case SubstepKind::kick:
      return Expression::symbol("kick");
    case SubstepKind::drift:
      return Expression::symbol("drift");
    case SubstepKind::member:
      break;
  }
  return Expression::symbol("step");
}

std::vector<Substep> expected_substeps(const Scheme& scheme) {
  std::vector<Substep> result;
  if (const auto* composition = std::get_if<Composition>(&scheme.method)) {
    for (const Expression& c : composition->substeps) result.push_back({SubstepKind::member, c});
  }
  if (const auto* splitting = std::get_if<Splitting>(&scheme.method)) {
    auto kick = splitting->kicks.begin();
    auto drift = splitting->drifts.begin();
    bool kicks = splitting->kick_first;
    while (kick != splitting->kicks.end() || drift != splitting->drifts.end()) {
      if (kicks && kick != splitting->kicks.end()) {
        result.push_back({SubstepKind::kick, *kick++});
      } else if (!kicks && drift != splitting->drifts.end()) {
        result.push_back({SubstepKind::drift, *drift++});
      }
      kicks = !kicks;
    }
  }
  return result;
}

void add_tableau(const RungeKutta& tableau, const StageTable& table, Identities& identities) {
  const std::size_t stages = tableau.b.size();
  auto claim = [&](std::string what, const Expression& emitted, const Expression& expected) {
    identities.claims.push_back({std::move(what), emitted, expected});
  };
  auto size = [](std::size_t n) { return Expression(static_cast<long>(n)); };
  claim("the number of weights", size(table.weight.size()), size(stages));
  claim("the number of stages", size(table.coupling.size()), size(stages));
  if (table.weight.size() != stages || table.coupling.size() != stages) return;
  for (std::size_t i = 0; i < stages; ++i) {
    claim(fmt::format("the weight b_{}", i + 1), table.weight[i], tableau.b[i]);
    claim(fmt::format("the number of couplings of stage {}", i + 1), size(table.coupling[i].size()),
          size(stages));
    if (table.coupling[i].size() != stages) return;
    for (std::size_t j = 0; j < stages; ++j) {
      // Implicit stages are coupled by a_ij / b_j.
      const Expression scale = tableau.is_explicit() ? Expression(1) : tableau.b[j];
      claim(fmt::format("the coefficient a_{},{}", i + 1, j + 1), table.coupling[i][j] * scale,
            tableau.a[i][j]);
    }
  }
}

}  // namespace

Identities sequence_identities(const Scheme& scheme, const Sequence& sequence) {
  Identities identities;
  const std::vector<Substep> expected = expected_substeps(scheme);
  const auto size = static_cast<long>(sequence.substeps.size());
  if (!expected.empty() || size != 0) {
    identities.claims.push_back(
        {"the number of substeps", Expression(size), Expression(std::ssize(expected))});
  }
  for (std::size_t i = 0; i < std::min(expected.size(), sequence.substeps.size()); ++i) {
    const Substep& emitted = sequence.substeps[i];
    identities.claims.push_back({fmt::format("the length of substep {}", i + 1),
                                 emitted.length * symbol_of(emitted.kind),
                                 expected[i].length * symbol_of(expected[i].kind)});
  }
  if (const auto* tableau = std::get_if<RungeKutta>(&scheme.method)) {
    add_tableau(*tableau, sequence.stages, identities);
  }
  return identities;
}

}  // namespace hamgen
