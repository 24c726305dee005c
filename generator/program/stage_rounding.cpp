#include "generator/program/stage_rounding.hpp"

#include "generator/mechanics/cancelling_forces.hpp"
#include "generator/solvers/array_matrix.hpp"

namespace hamgen {

std::optional<StageRounding> stages_rounded_beside(const LoweredStep& lowered) {
  const Mechanics& mechanics = lowered.plan.equations.mechanics;
  const Expression quarter = step_size() * step_size() * Expression(Rational(1, 4));
  std::optional<Expression> mobility;
  std::vector<Expression> lengths;
  Expression reach;
  if (mechanics.keeps_sums()) {
    const std::optional<CancellingForce> force = cancelling_force_in_loops(mechanics);
    if (!force || !second_order_of(mechanics)) return {};
    mobility = uniform_mass(mechanics);
    reach = force->reach();
    if (mobility) lengths.push_back(rounded_beside(*force, *mobility * quarter));
  } else {
    const std::map<int, CancellingForce> forces = cancelling_forces(mechanics);
    const std::optional<SecondOrder> order =
        forces.empty() ? std::nullopt : second_order_of(mechanics);
    if (!order) return {};
    mobility = order->mobility[0];
    reach = forces.begin()->second.reach();
    for (int i = 0; i < mechanics.degrees_of_freedom; ++i) {
      const auto force = forces.find(i);
      if (force == forces.end()) return {};
      const Expression& of_i = order->mobility[static_cast<std::size_t>(i)];
      lengths.push_back(rounded_beside(force->second, of_i * quarter));
    }
  }
  const std::optional<Expression> of_q = common_length(mechanics, lengths);
  if (!of_q) return {};
  if (lowered.second_order) return StageRounding{*of_q, 0, reach};
  // They move q by way of h dH/dp.
  const Expression of_p = *of_q * Expression(2) / (*mobility * step_size());
  return StageRounding{*of_q, Expression::apply("abs", {of_p}), reach};
}

void add_rounding(RoutineBuilder& b, const StageRounding& rounding, int coordinates, int times) {
  const KernelRange each = counting("j", coordinates);
  const auto at = [&](const char* array, int first = 0) {
    return b.at("start", array, {affine("j", first)});
  };
  const Expression near = b.at("start", "near");
  const Expression far = near * b.at("k", "reach") * Expression(Rational(1, times));
  b.body().push_back({Assign{near.name(), 0}});
  b.body().push_back(for_each(each, {{Accumulate{near.name(), at("state") * at("state")}}}));
  b.body().push_back({Assign{near.name(), nearness(far)}});
  const auto add = [&](int first, const char* length) {
    const Expression rounded = at("state", first) + b.at("k", length) * near;
    b.body().push_back(for_each(each, {{Assign{at("beside", first).name(), rounded}}}));
  };
  add(0, "beside");
  if (!rounding.p.is_zero()) add(coordinates, "beside_p");
}

}  // namespace hamgen
