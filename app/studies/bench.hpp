// Methods compared: errors and run times, a row for a method with a step size.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/studies/bench_choice.hpp"
#include "app/studies/bench_measure.hpp"
#include "app/studies/reference.hpp"
#include "runtime/provenance.hpp"

namespace hamgen::app {

struct BenchAnswer {  // which method takes the least time for an error
  double target = 0.0;
  std::optional<std::size_t> row;  // empty if no row reaches it
};

struct Bench {
  std::string model;  // its name
  std::string path;   // as typed
  std::string scene;
  double time = 0.0;
  Observed observed = Observed::state;
  std::vector<BenchMethod> methods;
  std::vector<BenchRow> rows;
  ReferenceSolution reference;
  std::vector<BenchAnswer> answers;  // an answer a target
  bool is_stopped = false;           // before all was measured
  runtime::Provenance provenance;
};

}  // namespace hamgen::app
