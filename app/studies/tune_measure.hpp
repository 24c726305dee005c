// Integrations with a gauge whose coefficients are run-time parameters.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/studies/load_integrator.hpp"
#include "app/studies/stop.hpp"
#include "app/studies/tune_gauge.hpp"
#include "generator/language/scene.hpp"
#include "runtime/integrator.hpp"

namespace hamgen::app {

struct Measurement {
  std::string failure;               // empty if all steps were done
  double energy_spread = 0.0;        // max H - min H over all states, the first included
  double energy_error = 0.0;         // max |H - H(0)|
  double energy_scale = 0.0;         // see runtime::Judge::energy_terms
  std::vector<runtime::Wide> state;  // the last, of all degrees of freedom
};

// A model compiled with beta = h B, gamma = h G; the same code for all coefficients.
class GaugedIntegrator {
 public:
  // `base` has sizes, folded parameters and the scalar.
  GaugedIntegrator(const SourceText& source, const Request& base, const GaugeShape& shape,
                   const SceneRequest& scene, const CompilerChoice& compiler, StopFlag stop);

  // From the scene's initial state; safe to call from several threads at once.
  [[nodiscard]] Measurement measure(const std::vector<double>& coefficients, double h,
                                    long steps) const;

 private:
  StopFlag stop_;
  PluginSource plugin_;
  SceneValues scene_;
  std::shared_ptr<const runtime::Library> library_;
  runtime::InitialValues start_;
  // Of the coefficients among the parameters; none of one whose degree of freedom rests.
  std::vector<std::optional<std::size_t>> places_;
};

}  // namespace hamgen::app
