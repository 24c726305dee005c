// What an ensemble says of itself.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/studies/ensemble.hpp"

namespace hamgen::app {

struct EnsembleSummary {
  long long count = 0;
  long long steps = 0;  // of all
  std::array<long long, runtime::kStatuses> ended = {};
  // Of the energy, of those that came to their end: |H - H(0)|, and of each one's own scale where
  // all of them have one (runtime::Judge::energy_terms).
  double largest_error = 0.0;
  double largest_relative_error = 0.0;
  bool has_scale = true;
};

void add(EnsembleSummary& summary, const std::vector<EnsembleRow>& rows, std::size_t energy_error);

struct EnsembleTitle {
  std::string model, scene, scheme;
  double h = 0.0;
  long steps = 0;
  std::vector<std::string> varied;
  std::vector<std::string> columns;
  std::string output;
  bool watches_energy = true;
  long long done_before = 0;  // trajectories, in an earlier command
  long long spoilt = 0;       // records that were done again
};

// "9876 done, 124 escaped".
[[nodiscard]] std::string endings_text(const EnsembleSummary& summary);
[[nodiscard]] std::string ensemble_text(const EnsembleSummary& summary, const EnsembleTitle& title);
[[nodiscard]] std::string ensemble_json(const EnsembleSummary& summary, const EnsembleTitle& title);

}  // namespace hamgen::app
