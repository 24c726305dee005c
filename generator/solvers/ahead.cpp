#include "generator/solvers/ahead.hpp"

#include <algorithm>
#include <set>

namespace hamgen {

namespace {

using Symbols = std::set<std::string>;

// The only block that iterates, if it is Newton's; null else.
const Block* only_newton(const SolvePlan& plan) {
  const Block* only = nullptr;
  for (const Block& block : plan.blocks) {
    if (block.kind == BlockKind::fixed_point) return nullptr;
    if (block.kind != BlockKind::newton) continue;
    if (only != nullptr) return nullptr;
    only = &block;
  }
  return only;
}

// Does it take as long as some ten products, one after the other: a function, a root, or a power
// that is as many?
bool is_slow(const Expression& e) {
  if (e.kind() == Kind::function) return e.name() != "abs";
  if (e.kind() != Kind::power) return false;
  const Expression& exponent = e.operands()[1];
  if (!exponent.is_number() || exponent.number().get_den() != 1) return true;
  return abs(exponent.number()) >= 32;
}

// The symbols of all of these in an expression; each node is looked at once.
class SlowSymbols {
 public:
  Symbols found;
  void collect(const Expression& e) {
    if (!seen_.insert(e.identity()).second) return;
    if (is_slow(e)) collect_symbols(e, found);
    for (const Expression& operand : e.operands()) collect(operand);
  }

 private:
  std::set<const void*> seen_;
};

}  // namespace

bool waits_for_functions(const SolvePlan& plan) {
  const StepEquations& equations = plan.equations;
  const bool plain = equations.scheme.is_member() && !equations.function && !plan.arrays;
  const Block* block = plain && !plan.sweeps ? only_newton(plan) : nullptr;
  if (block == nullptr || block->simplified) return false;
  // More unknowns have more to do meanwhile: with two of them nothing is gained.
  if (block->unknowns.size() > 1) return false;
  SlowSymbols slow;
  for (const auto* members : {&block->unknowns, &block->torn}) {
    for (const int i : *members) {
      for (const int k : equations.row_gradients(i))
        slow.collect(equations.mechanics.gradient[static_cast<std::size_t>(k)]);
    }
  }
  bool waits = false;
  for (int v = 0; v < 2 * equations.mechanics.degrees_of_freedom; ++v) {
    if (!slow.found.contains(equations.mechanics.variable(v).name())) continue;
    if (std::ranges::find(block->unknowns, v) == block->unknowns.end()) return false;
    waits = true;
  }
  return waits;
}

}  // namespace hamgen
