// Whether what is claimed of smaller systems holds of a large one.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "generator/verify/growth.hpp"
#include "generator/verify/independent_sums.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {

namespace {

// How far the instances of loops reach, in elements.
long reach_of(const std::vector<Kernel>& kernels, const QuantityList& variables) {
  long reach = 0;
  for (const Kernel& kernel : kernels) {
    std::set<long> elements;
    for (const Slot& slot : kernel.slots) {
      const long first = least_value(slot.position, kernel.ranges);
      if (!slot.position.factors.empty())
        elements.insert(variables.element(static_cast<std::size_t>(first)));
    }
    if (!elements.empty()) reach = std::max(reach, *elements.rbegin() - *elements.begin());
  }
  return reach;
}

}  // namespace

long least_size_of_order(const StepEquations& equations) {
  if (!equations.function || equations.function->kernels.empty()) return 0;
  const QuantityList& variables = equations.mechanics.variables;
  const long of_k = reach_of(equations.mechanics.kernels, variables);
  const long of_flow = equations.function->order * reach_of(equations.energy_kernels, variables);
  // Two ends, as far as K knows them, and what lies between.
  return 2 * (of_flow + 2 * of_k) + 1;
}

namespace {

struct Compared {
  std::array<SizedOutline, 3> sizes;
  std::string where;  // said before what differs
};

// What has to be the same, longer: the sums of H, those of K, the routines; of the large system and
// of the third of the smaller ones.
std::vector<Compared> compared(const Mechanics& mechanics, const SolvePlan& plan,
                               const Program& code, const SmallerSystems& smaller) {
  const auto& [constant, size, first, second, third] = smaller;
  const std::set<std::string> whole = {"invariants", "events"};
  std::vector<Compared> list;
  const auto add = [&](const auto& of_first, const auto& of_second, long longer, const auto& of,
                       const std::string& where = "") {
    list.push_back({{{{first.size, of_first}, {second.size, of_second}, {longer, of}}}, where});
  };
  const auto add_size = [&](long longer, const Mechanics& of, const Program& by) {
    add(outline(first.mechanics.kernels), outline(second.mechanics.kernels), longer,
        outline(of.kernels));
    if (plan.equations.function && longer == size) {
      const auto of_step = [](const SolvePlan& each) {
        return outline(each.equations.mechanics.kernels);
      };
      add(of_step(first.plan), of_step(second.plan), longer, of_step(plan), "in K ");
    }
    add(outline(first.program, whole), outline(second.program, whole), longer, outline(by, whole));
  };
  add_size(size, mechanics, code);
  if (third) add_size(third->size, third->mechanics, third->program);
  return list;
}

}  // namespace

std::optional<std::string> why_not_inherited(const Mechanics& mechanics, const SolvePlan& plan,
                                             const Program& code, const SmallerSystems& smaller) {
  if (least_size_of_order(plan.equations) > smaller.first.mechanics.degrees_of_freedom)
    return "the flow reaches farther than the smaller ones are long";
  if (!smaller.third && sums_over_pairs(mechanics))
    return "its pairs are looked at in two sizes only";
  if (smaller.first.mechanics.of_sums != mechanics.of_sums ||
      smaller.second.mechanics.of_sums != mechanics.of_sums)
    return "H is another function of its sums";
  std::set<std::string> readers;
  for (const Compared& each : compared(mechanics, plan, code, smaller)) {
    if (const auto why = why_not_longer(each.sizes)) return each.where + *why;
    readers.merge(readers_of_sums(each.sizes));
  }
  for (const std::string& routine : readers) {
    if (!are_sums_independent(smaller.first, routine))
      return fmt::format("the sums over all elements in {} depend on each other", routine);
  }
  return {};
}

long least_size_of_loops(const Mechanics& mechanics, const SolvePlan& plan, const Program& code,
                         const SmallerSystems& smaller) {
  long least = 0;
  for (const Compared& each : compared(mechanics, plan, code, smaller))
    least = std::max(least, least_size(each.sizes));
  return least;
}

long instances_of_loops(const Mechanics& mechanics) {
  double total = 0;
  for (const Kernel& kernel : mechanics.kernels) {
    double count = 1;
    for (const KernelRange& range : kernel.ranges) {
      const AffineIndex& end = range.upper.factors.empty() ? range.upper : range.lower;
      const AffineIndex& begin = range.lower.factors.empty() ? range.lower : range.upper;
      count *= std::max(1.0, std::abs(static_cast<double>(end.constant - begin.constant)));
    }
    total += kernel.ranges.size() > 1 ? count / 2 : count;
  }
  return static_cast<long>(std::min(total, 1e18));
}

std::string sizes_text(const SmallerSystems& smaller) {
  const std::string& name = smaller.constant;
  const long first = smaller.first.size;
  const long second = smaller.second.size;
  if (!smaller.third) return fmt::format("{0} = {1} and {0} = {2}", name, first, second);
  return fmt::format("{0} = {1}, {0} = {2} and {0} = {3}", name, first, second,
                     smaller.third->size);
}

bool sums_over_pairs(const Mechanics& mechanics) {
  return std::ranges::any_of(mechanics.kernels,
                             [](const Kernel& kernel) { return kernel.ranges.size() > 1; });
}

}  // namespace hamgen
