// The web page of `hamgen report`: one file that needs no other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/output/report_figures.hpp"
#include "app/studies/modified_energy.hpp"
#include "generator/mechanics/mechanics.hpp"
#include "generator/verify/linear_stability.hpp"

namespace hamgen::app {

struct ReportPicture {
  std::string name;
  std::string caption;
  std::string svg;         // empty if it could not be drawn
  std::string narrow_svg;  // of a large one, for narrow screens
  bool large = false;
};

struct ReportContent {
  const PluginSource* plugin = nullptr;
  const Mechanics* mechanics = nullptr;
  const SceneValues* scene = nullptr;
  const Bench* bench = nullptr;  // its first answer is that of the page
  BenchRow row;                  // the page's step on it
  Proof proof;
  std::vector<LinearPoint> linear;
  std::optional<ModifiedEnergy> modified;
  OrbitSummary orbit;
  std::vector<ReportPicture> pictures;
  std::string header;   // of the page's step
  std::string file;     // of the model, without its folder
  std::string command;  // that emits the header
  std::string path;     // of the model, as typed
};

[[nodiscard]] std::string report_page(const ReportContent& content);
// The same as values, with the names of its files.
[[nodiscard]] std::string report_json(const ReportContent& content, const std::string& directory);

}  // namespace hamgen::app
