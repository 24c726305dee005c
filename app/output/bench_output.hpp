// What `hamgen bench` says: a table to read, CSV, JSON and a picture of the same rows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/output/plot.hpp"
#include "app/studies/bench_choice.hpp"
#include "app/studies/bench_measure.hpp"
#include "runtime/provenance.hpp"

namespace hamgen::app {

struct BenchAnswer {  // to --target
  double target = 0.0;
  std::optional<std::size_t> row;  // empty if no row reaches it
  std::string command;             // `hamgen generate` for it
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
  std::optional<BenchAnswer> answer;
  runtime::Provenance provenance;
};

[[nodiscard]] std::string table_text(const Bench& bench);
[[nodiscard]] std::string csv_text(const Bench& bench);
[[nodiscard]] std::string json_text(const Bench& bench);
// Energy error and state error against run time, a line a method.
[[nodiscard]] Plot picture_of(const Bench& bench);

}  // namespace hamgen::app
