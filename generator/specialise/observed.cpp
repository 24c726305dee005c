// The quantities that a scene looks at.
#include "generator/specialise/specialisation.hpp"

namespace hamgen {

Model observed(Model model, const SceneValues& scene) {
  std::erase_if(model.invariants, [&scene](const Invariant& each) {
    return !each.is_event() && !observes(scene, each.name);
  });
  for (const auto* formulas : {&scene.formulas, &scene.watched}) {
    for (const ObservedFormula& formula : *formulas) {
      model.invariants.push_back({.name = formula.name,
                                  .value = formula.value,
                                  .text = formula.text,
                                  .comment = {},
                                  .span = formula.value->span,
                                  .only_observed = true});
    }
  }
  return model;
}

}  // namespace hamgen
