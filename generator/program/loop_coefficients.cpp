#include "generator/program/loop_coefficients.hpp"

#include "generator/program/routine_builder.hpp"

namespace hamgen {

// D = h (h alpha (1 - alpha) m / (1 + h beta m) - gamma).
Expression scale_of(const StepWeights& weights, const Expression& mass) {
  const Expression h = step_size();
  const auto& [alpha, beta, gamma] = weights.member;
  return h *
         (h * alpha * (Expression(1) - alpha) * mass / (Expression(1) + h * beta * mass) - gamma);
}

std::vector<AffineIndex> loop_mass_index(const ArrayPlan& plan, const std::string& index) {
  return plan.mass ? std::vector<AffineIndex>{} : std::vector{affine(index)};
}

std::optional<Coefficients> loop_coefficients(const Environment& environment,
                                              const StepWeights& weights, const ArrayPlan& plan,
                                              bool tangent, bool tells_momenta,
                                              const std::optional<StateRounding>& beside) {
  const int n = environment.degrees_of_freedom;
  const bool needs_drift = plan.reduced && weights.p_by_p.has_value();
  const bool needs_scale = plan.reduced && plan.matrix.has_value();
  const std::vector<AffineIndex> index = loop_mass_index(plan, "i");
  Record record{.name = "Coefficients",
                .fields = {},
                .remark = {"What depends on h and the parameters alone."}};
  RoutineBuilder b({.name = "prepare",
                    .result = {.type = "Coefficients", .object = "k"},
                    .arguments = {parameters_argument(), {.name = "h"}}});
  environment.bind_parameters(b.routine());
  for (const auto& [name, value, remark] : weights.coefficients) {
    record.fields.push_back({.name = name, .remark = remark});
    b.body().push_back({Assign{b.at("k", name).name(), value}});
  }
  const bool one_mass = plan.mass.has_value();
  const std::vector<int> sizes = one_mass ? std::vector<int>{} : std::vector<int>{n};
  if (needs_drift) {
    record.fields.push_back({.name = "drift", .sizes = {n}, .remark = "dH/dp_i at p = 0"});
    b.body().push_back({Array{"zero", {n}}});
    b.body().push_back(
        {Call{.routine = "kinetic_gradient", .arguments = {{"par"}, {"zero"}, {"k", "drift"}}}});
  }
  const bool is_number = one_mass && plan.mass->is_number();
  const bool keeps_mass = !is_number || needs_drift || tangent || plan.constant_matrix;
  if (plan.reduced && keeps_mass && (needs_drift || needs_scale || tells_momenta)) {
    record.fields.push_back({.name = "mass", .sizes = sizes, .remark = "d2H/dp_i^2"});
    if (one_mass) {
      b.body().push_back({Assign{b.at("k", "mass").name(), *plan.mass}});
    } else {
      b.body().push_back({Call{.routine = "masses", .arguments = {{"par"}, {"k", "mass"}}}});
    }
  }
  if (needs_scale) {
    record.fields.push_back(
        {.name = "scale", .sizes = sizes, .remark = "the matrix is I + scale V''"});
    const Expression value = scale_of(weights, keeps_mass ? b.at("k", "mass", index) : *plan.mass);
    Body each{{Assign{b.at("k", "scale", index).name(), value}}};
    if (one_mass) {
      b.body().push_back(std::move(each.front()));
    } else {
      b.body().push_back(for_each(counting("i", n), std::move(each)));
    }
  }
  const auto rounding = beside ? beside->coefficients() : std::vector<NamedWeight>();
  for (const auto& [name, value, remark] : rounding) {
    record.fields.push_back({.name = name, .remark = remark});
    b.body().push_back({Assign{b.at("k", name).name(), value}});
  }
  if (record.fields.empty()) return {};
  return Coefficients{.record = std::move(record), .prepare = b.take(), .places = {}};
}

}  // namespace hamgen
