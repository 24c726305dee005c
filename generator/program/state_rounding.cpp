#include "generator/program/state_rounding.hpp"

#include "generator/mechanics/cancelling_forces.hpp"
#include "generator/program/loop_coefficients.hpp"
#include "generator/solvers/array_matrix.hpp"

namespace hamgen {

namespace {

// That of momenta, where coordinates have this one: they move q by way of h dH/dp.
Expression of_momenta(const Expression& of_q, const Expression& mobility) {
  return Expression::apply("abs", {of_q * Expression(2) / (mobility * step_size())});
}

}  // namespace

std::optional<StateRounding> loops_rounded_beside(const StepEquations& equations,
                                                  const StepWeights& weights, bool torn) {
  const Mechanics mechanics = equations.of_energy();
  if (!mechanics.is_separable() || !has_diagonal_kinetic_energy(mechanics)) return {};
  const std::optional<CancellingForce> force = cancelling_force_in_loops(mechanics);
  if (!force) return {};
  const std::optional<Expression> mass = uniform_mass(mechanics);
  if (!mass) return {};
  const Expression of_q = rounded_beside(*force, scale_of(weights, *mass));
  if (of_q.is_zero()) return {};
  return StateRounding{of_q, torn ? Expression(0) : of_momenta(of_q, *mass), force->reach()};
}

std::optional<StateRounding> stages_rounded_beside(const LoweredStep& lowered) {
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
  const bool torn = lowered.second_order.has_value();
  return StateRounding{*of_q, torn ? Expression(0) : of_momenta(*of_q, *mobility), reach};
}

std::vector<NamedWeight> StateRounding::coefficients() const {
  std::vector<NamedWeight> list = {{"beside_q", q, "what forces that cancel round q with"}};
  if (!p.is_zero()) list.push_back({"beside_p", p, "and p"});
  list.push_back({"reach", reach, "where that is: 1/q^2"});
  return list;
}

void StateRounding::add_fields(Record& start, int components) const {
  start.fields.push_back(
      {.name = "beside", .sizes = {components}, .remark = "what they are rounded with as well"});
  start.fields.push_back({.name = "near", .remark = "1 where forces cancel, 0 far from there"});
}

void add_rounding(RoutineBuilder& b, const StateRounding& rounding, const StateElements& state) {
  const Expression near = b.at("start", "near");
  const Expression far = near * b.at("k", "reach") * Expression(Rational(1, state.times));
  b.body().push_back({Assign{near.name(), 0}});
  b.body().push_back(for_each(state.each, {{Accumulate{near.name(), state.q * state.q}}}));
  b.body().push_back({Assign{near.name(), nearness(far)}});
  Body each;
  each.push_back({Assign{state.beside_q.name(), state.q + refined_length(b)}});
  if (!rounding.p.is_zero()) {
    const Expression of_p = b.at("k", "beside_p") * near;
    each.push_back({Assign{state.beside_p.name(), state.p + of_p}});
  }
  b.body().push_back(for_each(state.each, std::move(each)));
}

Expression refined_length(RoutineBuilder& b) {
  return b.at("k", "beside_q") * b.at("start", "near");
}

}  // namespace hamgen
