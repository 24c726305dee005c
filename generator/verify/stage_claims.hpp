// What the claims about the stages of implicit Runge-Kutta methods have in common.
#pragma once

#include <algorithm>

#include "generator/verify/claim_list.hpp"

namespace hamgen {

inline std::size_t nth(long i) { return static_cast<std::size_t>(i); }

// Row i of a table of the method, of stage i.
inline std::vector<Expression> row_of(SymbolicMachine& machine, const StageLayout& layout,
                                      const std::string& table, long i) {
  std::vector<Expression> row;
  for (long j = 0; j < layout.stages; ++j) {
    const long at = layout.by_component() ? j * layout.room() + i : i * layout.stages + j;
    row.push_back(machine.value(of_k(table, at)));
  }
  return row;
}

inline bool has_mobility(const StepUnderProof& step) {
  const std::vector<Field>& fields = step.code.record("Coefficients")->fields;
  return std::ranges::find(fields, "mobility", &Field::name) != fields.end();
}

// All that a stage has, or its coordinates where the momenta are eliminated.
inline long components_of(const IterationTrace& trace, const StageLayout& layout) {
  const bool half = 2 * std::ssize(trace.unknowns) == layout.count() && layout.by_component();
  return half ? layout.dimension / 2 : layout.dimension;
}

// The equations of the stages, Newton's matrix, what is refined, and the sum.
[[nodiscard]] Identities implicit_stages_identities(const StepUnderProof& step,
                                                    const Derivatives& derivatives);
// What the coordinates lack and what they get with what the momenta lack.
[[nodiscard]] Identities elimination_identities(const StepUnderProof& step);

}  // namespace hamgen
