// hamgen certify: how far the steps of a run are from the exact map of their method.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/studies/certify_step.hpp"
#include "app/studies/progress.hpp"
#include "app/studies/setting.hpp"
#include "app/studies/stop.hpp"
#include "runtime/integrator.hpp"

namespace hamgen::app {

struct CertifyRequest {
  const PluginSource* plugin = nullptr;
  std::shared_ptr<const runtime::Library> library;  // of the plugin
  const SceneValues* scene = nullptr;               // complete
  const Scheme* scheme = nullptr;                   // of the plugin
  const runtime::InitialValues* start = nullptr;
  long every = 0;  // looks at steps 1, 1 + every, ...; 0: chosen so that it takes seconds
  ProgressSink on_progress = {};
  StopFlag stop = nullptr;
};

struct Certificate {
  std::string method;
  bool symplectic = false;  // the exact map is, for every H
  bool solves = false;      // equations: there is a region of uniqueness
  long steps = 0;           // that the run took, as far as it was followed
  long every = 1;
  long certified = 0;
  long failed = 0;
  // Over the certified steps.
  double units = 0.0;  // the largest, see StepDistance
  long worst_step = 0;
  std::string worst_component;  // "q[3]"
  double radius = 0.0;          // the smallest
  double epsilon = 0.0;
  long first_failed = 0;
  std::string failure;  // of the first that failed
  // The run failed in step `steps` + 1, or was stopped: how; empty if all steps were done.
  std::string ended;

  [[nodiscard]] bool holds() const { return failed == 0 && ended.empty() && certified > 0; }
};

// Throws UsageError, with the reason, for a method whose steps cannot be certified, such as sweeps,
// which leave the step unsolved; ToolError where hamgen was built without Arb.
void require_certifiable(const Request& method, const Model& model, const Scheme& scheme);

// Of a method for which that does not throw.
[[nodiscard]] Certificate certify(const CertifyRequest& request);

// The number that the scalar makes of hi + lo.
[[nodiscard]] ExactSum in_scalar(const runtime::Wide& value, int scalar_digits);

}  // namespace hamgen::app
