// What the routines of an implicit Runge-Kutta method have in common: elements of their arrays.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "generator/program/environment.hpp"
#include "generator/program/linear_terms.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/program/routine_builder.hpp"

namespace hamgen {

class StageParts {
 protected:
  explicit StageParts(const LoweredStep& lowered)
      : layout_(*lowered.stage_layout),
        stages_(layout_.stages),
        dimension_(layout_.dimension),
        n_(layout_.dimension / 2),
        in_parts_(has_linear_forces(lowered.plan.equations.mechanics)) {}

  // With those that are none of a stage.
  [[nodiscard]] int unknowns() const { return layout_.count(); }
  [[nodiscard]] int coordinates() const { return layout_.room() * n_; }
  [[nodiscard]] bool by_component() const { return layout_.by_component(); }
  [[nodiscard]] bool has_spare_room() const { return layout_.room() > stages_; }

  // --- elements: of stage i or of a numbered one, component j, or j + `shift` -------------------

  [[nodiscard]] AffineIndex row(long shift = 0) const { return layout_.index("i", 0, "j", shift); }
  [[nodiscard]] AffineIndex row_of(int stage, long shift = 0) const {
    return layout_.index("", stage, "j", shift);
  }
  static Expression of_start(RoutineBuilder& b, const char* field, const AffineIndex& index) {
    return b.at("start", field, {index});
  }
  [[nodiscard]] Expression state(RoutineBuilder& b, long shift = 0) const {
    return of_start(b, "state", by_component() ? row(shift) : affine("j", shift));
  }
  // a_im / b_m and the like: turned over by component.
  Expression entry(RoutineBuilder& b, const char* table, const AffineIndex& m) const {
    std::vector<AffineIndex> indices = {affine("i"), m};
    if (by_component()) std::swap(indices[0], indices[1]);
    return b.at("k", table, indices);
  }
  // sum_m k.table[i][m] L_m
  Expression combination(RoutineBuilder& b, const char* table, long shift = 0) const {
    Expression sum(0);
    for (int m = 0; m < stages_; ++m) {
      const Expression factor = entry(b, table, affine(m));
      sum += factor * of_start(b, "slope", row_of(m, shift));
    }
    return sum;
  }

  // h b_i times this, see Note [constants in two parts] in step_builder.hpp.
  Expression scaled(RoutineBuilder& b, const Expression& slope) const {
    const Expression all = b.at("k", "scaled", {affine("i")});
    if (!in_parts_) return all * slope;
    const Expression high = b.at("k", "scaled_high", {affine("i")});
    return high * slope + (all - high) * slope;
  }

  // --- loops -------------------------------------------------------------------------------------

  [[nodiscard]] KernelRange all_stages() const { return counting("i", layout_.room()); }
  [[nodiscard]] KernelRange all_components() const { return counting("j", dimension_); }
  // Over all stages of the first `components`, or of all.
  [[nodiscard]] Instruction for_all(Body each, int components = 0) const {
    const KernelRange range = components > 0 ? counting("j", components) : all_components();
    Body inner;
    if (by_component()) {
      inner.push_back(in_lanes(all_stages(), layout_.packs(), std::move(each)));
      return for_each(range, std::move(inner));
    }
    inner.push_back(for_each(range, std::move(each)));
    return for_each(all_stages(), std::move(inner));
  }

  // --- calls -------------------------------------------------------------------------------------

  [[nodiscard]] static std::vector<Argument> with_start(bool report) {
    std::vector<Argument> list = {parameters_argument(),
                                  {.name = "k", .record = "Coefficients"},
                                  {.name = "start", .record = "Start", .changes = true}};
    if (report) list.push_back({.name = "report", .record = "StepReport", .changes = true});
    return list;
  }
  [[nodiscard]] static Call call(const char* routine, bool report = false) {
    Call result{.routine = routine, .arguments = {{"par"}, {"k"}, {"start"}}};
    if (report) result.arguments.push_back({"report"});
    return result;
  }

  StageLayout layout_;
  int stages_, dimension_, n_;
  bool in_parts_;
};

}  // namespace hamgen
