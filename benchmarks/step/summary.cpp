#include "benchmarks/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <string_view>

namespace hamgen::benchmarks {
namespace {

// ns per step of size h; negative if it was not measured.
double nanoseconds_per_step(const Row& row, const Repetitions& times) {
  return times.median(row.benchmark_name()) / row.steps_per_iteration;
}

double find(const std::vector<Row>& rows, const Repetitions& times, std::string_view problem,
            std::string_view method) {
  for (const Row& row : rows) {
    if (row.problem == problem && row.method == method) return nanoseconds_per_step(row, times);
  }
  return -1;
}

void print_ratio(std::ostream& out, std::string_view text, double above, double below) {
  if (above > 0 && below > 0) out << fmt::format("  {:<52} {:8.2f}\n", text, above / below);
}

}  // namespace

void Repetitions::ReportRuns(const std::vector<Run>& runs) {
  std::vector<Run> shown;
  for (const Run& run : runs) {
    const bool aggregate = run.run_type == Run::RT_Aggregate;
    const bool wanted = run.aggregate_name == "median" || run.aggregate_name == "cv";
    if (aggregate ? wanted : run.repetitions == 1 || run.error_occurred) shown.push_back(run);
    if (run.run_type == Run::RT_Iteration && !run.error_occurred && run.iterations > 0) {
      nanoseconds_[run.run_name.function_name].push_back(run.cpu_accumulated_time * 1e9 /
                                                         static_cast<double>(run.iterations));
    }
  }
  if (!shown.empty()) ConsoleReporter::ReportRuns(shown);
}

double Repetitions::median(const std::string& benchmark_name) const {
  const auto found = nanoseconds_.find(benchmark_name);
  if (found == nanoseconds_.end()) return -1;
  std::vector<double> sorted = found->second;
  std::ranges::sort(sorted);
  const std::size_t middle = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}

void print_summary(std::ostream& out, const std::vector<Row>& rows, const Repetitions& times,
                   long long accuracy_steps) {
  out << fmt::format(
      "\nCPU time per step of size h = 0.1, median of the repetitions; errors over {} steps\n",
      accuracy_steps);
  std::vector<std::string> problems;
  for (const Row& row : rows) {
    if (std::ranges::find(problems, row.problem) == problems.end()) problems.push_back(row.problem);
  }
  for (const std::string& problem : problems) {
    out << fmt::format("\n{:<24} {:>8} {:>15} {:>13} {:>12}\n", problem, "ns/step", "energy spread",
                       "energy drift", "step error");
    for (const Row& row : rows) {
      const double time = nanoseconds_per_step(row, times);
      if (row.problem != problem || time <= 0) continue;
      const Accuracy& a = row.accuracy;
      out << fmt::format("  {:<22} {:>8.1f} {:>15.4e} {:>13.1e} {:>12}\n", row.method, time,
                         a.energy_spread, a.energy_drift,
                         a.step_error > 0 ? fmt::format("{:.1e}", a.step_error) : "-");
    }
  }
  for (const std::string& problem : problems) {
    const double hamgen = find(rows, times, problem, "hamgen");
    out << "\n" << problem << "\n";
    print_ratio(out, "GSL rk2imp / hamgen, a step of size h",
                find(rows, times, problem, "GSL rk2imp, step h"), hamgen);
    print_ratio(out, "GSL rk2imp / hamgen, the same trajectory (GSL: 2h)",
                find(rows, times, problem, "GSL rk2imp, step 2h"), hamgen);
    print_ratio(out, "hamgen / hand-written", hamgen, find(rows, times, problem, "hand-written"));
  }
}

}  // namespace hamgen::benchmarks
