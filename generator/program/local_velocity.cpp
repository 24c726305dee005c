#include "generator/program/local_velocity.hpp"

#include <algorithm>

#include "generator/program/names.hpp"

namespace hamgen {

namespace {

// Of the loop's index instead of the kernel's own, which is `first` where that is 0.
AffineIndex counted_from_zero(const AffineIndex& index, const KernelRange& range, long first,
                              const std::string& of_loop) {
  AffineIndex result{index.constant, {}};
  for (const auto& [name, factor] : index.factors) {
    if (name != range.index) {
      result.factors[name] = factor;
      continue;
    }
    result.constant += factor * first;
    result.factors[of_loop] = factor;
  }
  return result;
}

bool is_full_range(const Kernel& kernel, int n) {
  if (kernel.ranges.size() != 1 || kernel.sum || kernel.slots.size() != 1) return false;
  const KernelRange& range = kernel.ranges.front();
  const AffineIndex& position = kernel.slots.front().position;
  return position.factors == std::map<std::string, long>{{range.index, 1}} &&
         least_value(position, kernel.ranges) == n &&
         largest_value(position, kernel.ranges) == 2L * n - 1;
}

}  // namespace

void LocalVelocity::compute(Body& body) const {
  for (const Statement& s : evaluation.statements)
    body.push_back({Let{s.name, s.value}, {}, {.terms = terms}});
}

std::optional<LocalVelocity> local_velocity(const Mechanics& mechanics, const std::string& index) {
  if (!mechanics.is_separable() || !mechanics.sums.empty()) return {};
  const int n = mechanics.degrees_of_freedom;
  if (std::ranges::count_if(mechanics.kernels, uses_momenta) != 1) return {};
  const Kernel& kernel = *std::ranges::find_if(mechanics.kernels, uses_momenta);
  if (!is_full_range(kernel, n)) return {};
  const KernelRange& range = kernel.ranges.front();
  const Slot& slot = kernel.slots.front();
  const long first = n - slot.position.constant;

  LocalVelocity result{.terms = kernel.terms};
  result.momentum = slot.symbol.substr(0, slot.symbol.find('[')) + "[" + index + "]";
  Substitution names{{slot.symbol, Expression::symbol(result.momentum, kRankOfTemporary)}};
  const std::string number = "index(" + index + ")";
  result.places[number] = {.object = {}, .indices = {{first, {{index, 1}}}}};
  names.emplace(range.index, Expression::symbol(number, kRankOfParameter));
  for (const ParameterSlot& parameter : kernel.parameters) {
    result.places[parameter.symbol] = {
        .object = "par",
        .field = member_identifier(parameter.parameter),
        .indices = {counted_from_zero(parameter.position, range, first, index)}};
  }
  result.evaluation = evaluate_together({substitute(kernel.gradient.front(), names)});
  return result;
}

}  // namespace hamgen
