// Products with constants in two parts.
#include "generator/program/linear_terms.hpp"
#include "generator/program/step_builder.hpp"

namespace hamgen {

Parts StepBuilder::constant_in_two_parts(const Expression& constant) {
  return in_two_parts(constant, [&](const std::string& name, const Expression& value, bool apart) {
    const Lowering::Keep keep = apart ? Lowering::Keep::apart : Lowering::Keep::yes;
    return name_once(name, value, kCoefficients, keep);
  });
}

bool StepBuilder::has_linear_force() const {
  for (int k = 0; k < n_; ++k) {
    if (linear_terms_.are_in(equations_.stage_gradient(k))) return true;
  }
  return false;
}

Expression StepBuilder::gradient_in_parts(int k, int section) {
  return linear_terms_.split(
      equations_.stage_gradient(k),
      {.in_two_parts = [&](const Expression& constant) { return constant_in_two_parts(constant); },
       .at_stage = [&](const Expression& sum) { return at_stage(sum); },
       .of_small_parts =
           [&](const Expression& sum) {
             return named_rest(gradient_[index(k)].name(), sum, section);
           }});
}

// Where the gradient may be no more than a sum of linear terms these may cancel.
Parts StepBuilder::step_size_for(int k) {
  const bool splits = splits_products_ && !keeps_gradients_ &&
                      linear_terms_.may_be_all_of(equations_.stage_gradient(k));
  return splits ? constant_in_two_parts(step_size()) : Parts{step_size(), Expression(0)};
}

}  // namespace hamgen
