// What one run ends with: a table for every problem, and the ratios.
#pragma once
#include <benchmark/benchmark.h>

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/accuracy.hpp"

namespace hamgen::benchmarks {

struct Row {
  std::string problem;
  std::string method;
  double steps_per_iteration = 0;
  Accuracy accuracy;

  [[nodiscard]] std::string benchmark_name() const { return problem + "/" + method; }
};

// Keeps the CPU time of every repetition; prints their median and their variation.
class Repetitions : public benchmark::ConsoleReporter {
 public:
  Repetitions() : ConsoleReporter(OO_None) {}  // no colours
  void ReportRuns(const std::vector<Run>& runs) override;
  // Median over the repetitions [ns per iteration]; negative if the benchmark did not run.
  [[nodiscard]] double median(const std::string& benchmark_name) const;

 private:
  std::map<std::string, std::vector<double>> nanoseconds_;
};

void print_summary(std::ostream& out, const std::vector<Row>& rows, const Repetitions& times,
                   long long accuracy_steps);

}  // namespace hamgen::benchmarks
