#include "generator/program/sequence.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

// Kicks and drifts in turn, until both are used up.
std::vector<Substep> substeps_of(const Splitting& splitting) {
  std::vector<Substep> result;
  const std::size_t count = splitting.kicks.size() + splitting.drifts.size();
  for (std::size_t i = 0; i < count; ++i) {
    if ((i % 2 == 0) == splitting.kick_first) {
      result.push_back({SubstepKind::kick, splitting.kicks.at(i / 2)});
    } else {
      result.push_back({SubstepKind::drift, splitting.drifts.at(i / 2)});
    }
  }
  return result;
}

// Note [coupling of implicit stages]
// The increments k_j = h b_j f_j are what an implicit step adds up, so its stages are coupled by
// a_ij / b_j: in these the condition of symplecticity is coupling_ij + coupling_ji = 1, which a
// format can keep exactly in rounded numbers.
StageTable table_of(const RungeKutta& tableau) {
  StageTable table{.coupling = tableau.a, .weight = tableau.b};
  if (tableau.is_explicit()) return table;
  for (auto& row : table.coupling) {
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = row[j] / tableau.b[j];
  }
  return table;
}

}  // namespace

Sequence sequence_of(const Scheme& scheme) {
  Sequence sequence;
  if (const auto* splitting = std::get_if<Splitting>(&scheme.method)) {
    sequence.substeps = substeps_of(*splitting);
  } else if (const auto* composition = std::get_if<Composition>(&scheme.method)) {
    for (const Expression& length : composition->substeps) {
      sequence.substeps.push_back({SubstepKind::member, length});
    }
  } else if (const auto* tableau = std::get_if<RungeKutta>(&scheme.method)) {
    sequence.stages = table_of(*tableau);
  }
  return sequence;
}

std::vector<Expression> lengths_of(const Sequence& sequence, SubstepKind kind) {
  std::vector<Expression> lengths;
  for (const Substep& substep : sequence.substeps) {
    if (substep.kind == kind) lengths.push_back(substep.length);
  }
  return lengths;
}

}  // namespace hamgen
