// Indicators of chaos as text, CSV, JSON and pictures.
#pragma once

#include <string>
#include <vector>

#include "app/output/heat_map.hpp"
#include "app/output/plot.hpp"
#include "app/studies/chaos.hpp"
#include "app/studies/chaos_map.hpp"
#include "app/studies/orbit_frequencies.hpp"

namespace hamgen::app {

struct ChaosTitle {
  std::string model, scene, scheme;
  double h = 0.0;
  std::vector<std::string> coordinates;
};

[[nodiscard]] std::string chaos_text(const Chaos& chaos, const ChaosTitle& title);
[[nodiscard]] std::string frequencies_text(const std::vector<DegreeFrequencies>& degrees,
                                           const ChaosTitle& title);
// The samples in time.
[[nodiscard]] std::string chaos_csv(const Chaos& chaos,
                                    const std::vector<DegreeFrequencies>& degrees,
                                    const ChaosTitle& title);
[[nodiscard]] std::string chaos_json(const Chaos& chaos,
                                     const std::vector<DegreeFrequencies>& degrees,
                                     const ChaosTitle& title);
[[nodiscard]] Plot chaos_plot(const Chaos& chaos, const ChaosTitle& title);

// A number that a map shows.
struct Indicator {
  std::string name;   // "megno"
  std::string label;  // of the colours
  double (*value)(const ChaosSample&);
};
[[nodiscard]] const std::vector<Indicator>& all_indicators();

struct ChaosMapTable {
  const std::vector<ChaosAxis>* axes = nullptr;
  const std::vector<ChaosCell>* cells = nullptr;
};
[[nodiscard]] std::string chaos_map_text(const ChaosMapTable& map, const Indicator& indicator,
                                         const ChaosTitle& title);
[[nodiscard]] std::string chaos_map_csv(const ChaosMapTable& map, const ChaosTitle& title);
[[nodiscard]] std::string chaos_map_json(const ChaosMapTable& map, const ChaosTitle& title);
// The script of a picture: a plane of colours, or a line where there is one axis.
[[nodiscard]] std::string chaos_map_script(const ChaosMapTable& map, const Indicator& indicator,
                                           const ChaosTitle& title, const std::string& output);

}  // namespace hamgen::app
