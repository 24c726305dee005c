// Linear equations in loops: what their solution lacks, far below rounding.
#include <fmt/format.h>

#include <algorithm>

#include "generator/program/arithmetic.hpp"
#include "generator/program/kernel_routines.hpp"
#include "generator/program/loop_stage.hpp"

namespace hamgen {

bool has_no_linear_terms(const Mechanics& mechanics) {
  return std::ranges::all_of(mechanics.kernels, [](const Kernel& kernel) {
    Substitution zero;
    for (const Slot& slot : kernel.slots) zero.emplace(slot.symbol, Expression(0));
    return std::ranges::all_of(kernel.gradient, [&](const Expression& slope) {
      return substitute(slope, zero).is_zero();
    });
  });
}

Routine LoopStage::gradient_error() const {
  const auto array = [&](const char* name, int size, bool changes) {
    return Argument{.name = name, .sizes = {size}, .changes = changes, .decays = true};
  };
  RoutineBuilder b(
      {.name = "gradient_error",
       .remark = {"lost = H'' z - slope, far below rounding: what is left of the slope "
                  "without the products",
                  "it is the sum of, and what these and their differences lose."},
       .arguments = {parameters_argument()}});
  std::vector<Argument>& list = b.routine().arguments;
  if (raised()) list.push_back({.name = "h"});
  list.insert(list.end(),
              {array("q", n_, false), array("p", n_, false), array("slope", 2 * n_, false),
               array("left", 2 * n_, true), array("lost", 2 * n_, true)});
  Body begin;
  begin.push_back(
      {Assign{b.at("left", "", {affine("i")}).name(), b.at("slope", "", {affine("i")})}});
  begin.push_back({Assign{b.at("lost", "", {affine("i")}).name(), Expression(0)}});
  b.body().push_back(for_each(counting("i", 2 * n_), std::move(begin)));
  const int n = n_;
  const auto use = [n, count = 0](Routine& routine, Body& body, const HessianEntry& entry) mutable {
    const auto element = [&](const char* name, const StateElement& of, bool is_whole) {
      AffineIndex index = of.index;
      if (of.is_momentum && is_whole) index.constant += n;
      const Place place{name, "", {index}};
      routine.places.insert_or_assign(to_text(place), place);
      return Expression::symbol(to_text(place), kRankOfTemporary);
    };
    const Expression z = element(entry.column.is_momentum ? "p" : "q", entry.column, false);
    const Expression left = element("left", entry.row, true);
    const Expression lost = element("lost", entry.row, true);
    ++count;
    const auto let = [&](const char* name, const Expression& value) {
      const std::string symbol = fmt::format("{}({})", name, count);
      body.push_back({Let{symbol, value}});
      return Expression::symbol(symbol, kRankOfTemporary);
    };
    const auto names = [&](TermRole role, const Expression& value) {
      return let(role == TermRole::product ? "part" : "lost", value);
    };
    const RoundedTerm part =
        rounded_product(names, entry.value, z, !multiplies_exactly(entry.value));
    body.push_back({Collect{left.name(), lost.name(), -part.large}});
    if (!part.small.is_zero()) body.push_back({Accumulate{lost.name(), -part.small}});
  };
  Routine routine =
      kernel_entries(environment_, mechanics_, Part::all, b.take(), {"q"}, {"p"}, use);
  RoutineBuilder end(std::move(routine));
  const Expression left = end.at("left", "", {affine("i")});
  Body rest{{Assign{end.at("lost", "", {affine("i")}).name(),
                    -(left + end.at("lost", "", {affine("i")}))}}};
  end.body().push_back(for_each(counting("i", 2 * n_), std::move(rest)));
  return end.take();
}

Expression LoopStage::exact_lack(RoutineBuilder& b, Body& body, bool is_p,
                                 const Expression& extra) const {
  const char* field = is_p ? "p" : "q";
  const std::string stem = is_p ? "p_" : "q_";
  const Expression z = state(b, "z", field);
  const Expression bar = is_p ? momentum(b) : coordinate(b);
  const Gradient at = slope(b);
  const StageRow row =
      is_p ? weights_.row_of_p(b, body, at, true) : weights_.row_of_q(b, body, at, true);
  // The last of the differences cancels.
  std::vector<Expression> numbers{bar};
  for (const Expression& term : row.large) numbers.push_back(-term);
  std::string gap = stem + "gap";
  const auto names = [&, count = 0](TermRole role, const Expression& value) mutable {
    if (role == TermRole::difference_error) return b.let(body, gap + "_error", value);
    if (count > 0) gap = fmt::format("{}gap_{}", stem, count);
    ++count;
    return b.let(body, gap, value);
  };
  Expression small = state(b, "carry", field) + row.small + extra;
  const RoundedTerm left = rounded_difference(names, z, numbers, Errors::of_all_but_the_last);
  small += left.small;
  return left.large + b.let(body, stem + "small", small);
}

Expression LoopStage::own_share(RoutineBuilder& b) const {
  if (!needs_drift()) return Expression(1);
  return Expression::power(Expression(1) + *weights_.p_by_p * mass(b), Expression(-1));
}

void LoopStage::add_exact_lack(RoutineBuilder& b, Body& body) const {
  const auto at = [&](const char* field, bool momentum) {
    return b.at("start", field, {affine("i", momentum ? n_ : 0)});
  };
  const auto by = [](const std::optional<Expression>& weight, const Expression& value) {
    return weight ? *weight * value : Expression(0);
  };
  body.push_back(
      {of_stage("gradient_error", {{"start", "slope"}, {"start", "change"}, {"start", "lost"}}),
       {"What the equations lack, far below rounding."}});
  Body lack;
  Expression lost_q = at("lost", false);
  Expression lost_p = at("lost", true);
  const Expression of_p =
      exact_lack(b, lack, true, -by(weights_.p_by_q, lost_q) - by(weights_.p_by_p, lost_p));
  if (arrays_.reduced) {
    lack.push_back({Assign{at("moved", true).name(), of_p * own_share(b)}});
    lost_p = b.let(lack, "p_lost_in_all", lost_p + mass(b) * at("moved", true));
  } else {
    lack.push_back({Assign{at("lack", true).name(), of_p}});
  }
  const Expression of_q =
      exact_lack(b, lack, false, by(weights_.q_by_p, lost_p) + by(weights_.q_by_q, lost_q));
  lack.push_back({Assign{at("lack", false).name(), of_q}});
  body.push_back(for_each(elements(), std::move(lack)));
}

Call LoopStage::of_stage(const char* routine, std::vector<Place> arguments) const {
  std::vector<Place> list = {{"par"}};
  if (raised()) list.push_back({"h"});
  list.push_back({"start", "value"});
  list.push_back(arrays_.reduced ? Place{"start", "momentum"}
                                 : Place{"start", "value", {affine(n_)}});
  list.insert(list.end(), arguments.begin(), arguments.end());
  return {.routine = routine, .arguments = std::move(list)};
}

void LoopStage::add_exact_result(RoutineBuilder& b) const {
  Body& body = b.body();
  const auto at = [&](const char* field, bool momentum) {
    return b.at("start", field, {affine("i", momentum ? n_ : 0)});
  };
  Body moved{{Assign{at("moved", false).name(), at("lack", false)}},
             {Accumulate{at("value", false).name(), at("lack", false)}}};
  body.push_back(for_each(counting("i", unknowns()), std::move(moved)));
  body.push_back({of_stage("curvature", {{"start", "moved"}, {"start", "change"}})});

  Return end{.ranges = {elements()}};
  Body each;
  for (const bool is_p : {false, true}) {
    const char* field = is_p ? "p" : "q";
    const Expression sign(is_p ? -1 : 1);
    const auto [flow, flow_lost] =
        StepWeights::flow_of(b, each, !is_p, b.at("start", "slope", {affine("i", is_p ? 0 : n_)}));
    Expression change = at("lost", !is_p) + at("change", !is_p);
    // The torn momenta move with the force.
    if (!is_p && arrays_.reduced && weights_.p_by_q) {
      change += -mass(b) * own_share(b) * *weights_.p_by_q * at("change", false);
    }
    const Expression dz = state(b, "dz", field);
    const Expression rest = state(b, "rest", field);
    each.push_back({Assign{dz.name(), sign * flow}});
    each.push_back({Assign{
        rest.name(), state(b, "carry", field) + sign * flow_lost + sign * step_size() * change}});
    end.finite.push_back(dz.name());
    end.finite.push_back(rest.name());
  }
  body.push_back(for_each(elements(), std::move(each)));
  body.push_back({std::move(end)});
}

}  // namespace hamgen
