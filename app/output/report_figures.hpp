// The pictures of `hamgen report`.
#pragma once

#include <string>
#include <vector>

#include "app/output/plot.hpp"
#include "app/studies/bench.hpp"
#include "app/studies/reference.hpp"
#include "generator/language/scene.hpp"
#include "runtime/trajectory.hpp"

namespace hamgen::app {

struct Figure {
  std::string name;     // of its files: "energy" for energy.svg, energy.png, energy.gp
  std::string caption;  // a sentence or two
  Plot plot;
  bool large = false;  // as wide as the page, and drawn again for a narrow one
};

struct OrbitSummary {
  runtime::RunSummary run;  // of all the scene's steps
  std::string outcome;      // "done", or how it ended
  int scalar_digits = 53;   // binary, of its scalar
};

struct ReportFigures {
  OrbitSummary orbit;
  std::vector<Figure> figures;  // the errors against run time first
};

// What the page is about: a method, and its step on the bench.
struct ReportSubject {
  const BenchMethod* method = nullptr;
  const SceneValues* scene = nullptr;
  BenchRow row;  // of the scene's h, over the bench's time
};

// Integrates the scene with the method and draws the bench, the orbit in all planes of its space,
// the energy error over all the time and over its first steps, what else is conserved, and the
// state error of the bench's methods over its time.
[[nodiscard]] ReportFigures report_figures(const ReportSubject& subject, const SourceText& source,
                                           const Bench& bench, const ReferenceRequest& request);

}  // namespace hamgen::app
