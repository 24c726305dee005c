// A Poincare section as text, CSV, JSON and a picture.
#pragma once

#include <string>
#include <vector>

#include "app/output/plot.hpp"
#include "app/studies/section.hpp"

namespace hamgen::app {

// What the section is of, as it is written over it.
struct SectionTitle {
  std::string model, scene, scheme;
  std::string surface;  // "q1 = 0, rising"
  std::string first, second;
  std::vector<std::string> angles;  // of these, within a turn
  double energy = 0.0;
  double h = 0.0;
};

[[nodiscard]] std::string section_summary(const Section& section, const SectionTitle& title);
[[nodiscard]] std::string section_csv(const Section& section, const SectionTitle& title);
[[nodiscard]] std::string section_json(const Section& section, const SectionTitle& title);
[[nodiscard]] Plot section_plot(const Section& section, const SectionTitle& title);

}  // namespace hamgen::app
