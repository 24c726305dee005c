// The end of a step in loops: dz, and what is small beside it, by the gradient at the stage.
#include "generator/program/arithmetic.hpp"
#include "generator/program/loop_stage.hpp"

namespace hamgen {

Expression LoopStage::mass_of_result(RoutineBuilder& b) const {
  return arrays_.mass && arrays_.mass->is_number() ? *arrays_.mass : mass(b);
}

// Note [what the torn momenta lose]
// They are rounded, at every step alike where the products that they are made of have a pattern,
// and h m times that is missing in dq: two thirds of a bias of 1e-4 units of rounding a step.
Expression LoopStage::lost_of_momentum(RoutineBuilder& b, Body& each) const {
  // In this order: z and bar cancel without an error.
  const Expression z = state(b, "z", "p");
  const Expression bar = b.local("bar");
  const Expression carry = state(b, "carry", "p");
  const Gradient at = {b.at("start", "refinement.slope", {affine("i")}), Expression(0)};
  const StageRow row = weights_.row_of_p(b, each, at);
  const Expression moved = b.let(each, "moved", sum_of_row(b, each, carry, row, "small"));
  each.push_back({Let{bar.name(), z + moved}});
  return z - bar + moved;
}

// dz = h J grad H at the stage, which Refinement has where the unknowns are a fixed point.  The
// carry is no part of it where something is solved: at h = 0.3 what such a sum loses is a
// pattern, by which the form of a chain drifts by 3.7e-4 units of rounding a step.
void LoopStage::add_result(RoutineBuilder& b, bool refined) const {
  Return end{.ranges = {elements()}};
  Body each;
  for (const bool is_p : {false, true}) {
    const char* field = is_p ? "p" : "q";
    const int from = is_p ? 0 : n_;  // dH/dq moves p
    const auto flow = [&](const char* of) {
      const Expression slope = step_size() * b.at("start", of, {affine("i", from)});
      return is_p ? -slope : slope;
    };
    const Expression dz = state(b, "dz", field);
    const Expression carry = state(b, "carry", field);
    end.finite.push_back(dz.name());
    if (!has_rest()) {
      each.push_back({Assign{dz.name(), carry + flow("slope")}});
      continue;
    }
    Expression small = carry;
    Expression large = flow(refined ? "refinement.slope" : "slope");
    if (!refined && !is_p && in_parts()) {
      weights_.bind(b.routine());
      const auto [high, low] =
          StepWeights::flow_in_two_parts(b.at("start", "slope", {affine("i", n_)}));
      large = high;
      small = b.let(each, "q_small", carry + low);
    }
    if (refined) small += flow("refinement.change");
    if (!refined && is_sharp()) small += change_of_flow(b, is_p);
    const bool tells = refined && tells_momenta();
    if (tells && !is_p) {
      small += step_size() * mass_of_result(b) * lost_of_momentum(b, each);
    }
    if (weights_.shares) {
      const Expression slope =
          b.at("start", refined ? "refinement.slope" : "slope", {affine("i", from)});
      const auto [product, lost] = tells && is_p
                                       ? RoundedTerm{b.local("p_flow"), b.local("p_flow_lost")}
                                       : StepWeights::flow_of(b, each, !is_p, slope);
      large = is_p ? -product : product;
      small += is_p ? -lost : lost;
    }
    each.push_back({Assign{dz.name(), large}});
    const Expression rest = state(b, "rest", field);
    each.push_back({Assign{rest.name(), small}});
    end.finite.push_back(rest.name());
  }
  b.body().push_back(for_each(elements(), std::move(each)));
  b.body().push_back({std::move(end)});
}

// What H'' times the last increment adds: the torn momenta move with the force.
Expression LoopStage::change_of_flow(RoutineBuilder& b, bool is_p) const {
  const auto change = [&](int from) { return b.at("start", "change", {affine("i", from)}); };
  if (is_p) return -(step_size() * change(0));
  if (!arrays_.reduced) return step_size() * change(n_);
  if (!weights_.p_by_q) return Expression(0);
  weights_.bind(b.routine());
  return -(step_size() * mass_of_result(b) * own_share(b) * *weights_.p_by_q * change(0));
}

}  // namespace hamgen
