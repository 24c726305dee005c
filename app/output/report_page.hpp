// The web page of `hamgen report`: one file that needs no other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/output/bench_output.hpp"
#include "app/output/report_figures.hpp"
#include "app/studies/modified_energy.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen::app {

struct ReportPicture {
  std::string name;
  std::string caption;
  std::string svg;  // empty if it could not be drawn
};

struct ReportContent {
  const PluginSource* plugin = nullptr;
  const Mechanics* mechanics = nullptr;
  const SceneValues* scene = nullptr;
  const Bench* bench = nullptr;
  Proof proof;
  Proof linear;  // the lines of the linear part
  std::optional<ModifiedEnergy> modified;
  OrbitSummary orbit;
  std::vector<ReportPicture> pictures;
  std::string command;  // that emits the header
};

[[nodiscard]] std::string report_page(const ReportContent& content);

}  // namespace hamgen::app
