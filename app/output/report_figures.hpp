// The pictures of `hamgen report`.
#pragma once

#include <string>
#include <vector>

#include "app/output/bench_output.hpp"
#include "app/output/plot.hpp"
#include "app/studies/reference.hpp"
#include "generator/language/scene.hpp"
#include "runtime/trajectory.hpp"

namespace hamgen::app {

struct Figure {
  std::string name;     // of its files: "energy" for energy.svg, energy.png, energy.gp
  std::string caption;  // a sentence or two
  Plot plot;
};

struct OrbitSummary {
  runtime::RunSummary run;  // of all the scene's steps
  std::string outcome;      // "done", or how it ended
  int scalar_digits = 53;   // binary, of its scalar
};

struct ReportFigures {
  OrbitSummary orbit;
  std::vector<Figure> figures;
};

// Integrates the scene with the method and draws the phase portrait, the energy error over all the
// time and over its first steps, the state error of the bench's methods over its time, and the two
// pictures of the bench.
[[nodiscard]] ReportFigures report_figures(const BenchMethod& method, const SceneValues& scene,
                                           const SourceText& source, const Bench& bench,
                                           const ReferenceRequest& request);

}  // namespace hamgen::app
