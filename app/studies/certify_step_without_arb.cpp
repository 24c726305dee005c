// Where hamgen is built without Arb nothing can be certified.
#include "app/studies/certify_step.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {

struct StepCertifier::Balls {};

void StepCertifier::require_possible(const Model& /*model*/, const Scheme& /*scheme*/) {
  throw runtime::ToolError(
      {.message =
           "this hamgen was built without Arb, the library of ball arithmetic that steps are "
           "certified by\nhelp: apt-get install libflint-arb-dev libflint-dev, then configure "
           "with -DHAMGEN_WITH_ARB=ON and build again"});
}

StepCertifier::StepCertifier(const Model& model, const Scheme& scheme,
                             const StepNumbers& /*numbers*/, ModelState /*state*/) {
  require_possible(model, scheme);
}

StepCertifier::~StepCertifier() = default;

StepDistance StepCertifier::distance(const std::vector<ExactSum>& /*before*/,
                                     const std::vector<ExactSum>& /*after*/) {
  return {};
}

}  // namespace hamgen::app
