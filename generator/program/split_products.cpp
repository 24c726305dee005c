// Products with constants in two parts.
#include "generator/program/arithmetic.hpp"
#include "generator/program/linear_terms.hpp"
#include "generator/program/step_builder.hpp"

namespace hamgen {

Parts StepBuilder::in_two_parts(const Expression& constant) {
  const std::string name = "(" + to_text(constant) + ")";
  const Expression high =
      name_once("high" + name, kHighPart * constant, kCoefficients, Lowering::Keep::apart);
  // Without an error, for both are nearly the same.
  const Expression low = name_once("low" + name, constant - high, kCoefficients);
  return {high, low};
}

LinearTerms StepBuilder::linear_terms() const {
  std::set<std::string> stage;
  for (int v = 0; v < 2 * n_; ++v) stage.insert(equations_.stage(v).name());
  return LinearTerms(std::move(stage));
}

bool StepBuilder::has_linear_force() const {
  const LinearTerms terms = linear_terms();
  for (int k = 0; k < n_; ++k) {
    if (terms.are_in(equations_.stage_gradient(k))) return true;
  }
  return false;
}

Expression StepBuilder::with_split_products(const Expression& e, int section) {
  return linear_terms().split(
      e, {.in_two_parts = [&](const Expression& constant) { return in_two_parts(constant); },
          .at_stage = [&](const Expression& sum) { return at_stage(sum); },
          .define = [&](const std::string& name,
                        const Expression& value) { return name_once(name, value, section); }});
}

// Where the gradient may be no more than a sum of linear terms these may cancel.
Parts StepBuilder::step_size_for(int k) {
  const bool splits = splits_products_ && !keeps_gradients_ &&
                      linear_terms().may_be_all_of(equations_.stage_gradient(k));
  return splits ? in_two_parts(step_size()) : Parts{step_size(), Expression(0)};
}

}  // namespace hamgen
