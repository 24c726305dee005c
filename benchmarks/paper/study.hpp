// What all figures share: the compiled integrators, how long to integrate, where data go.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/paper/optimum.hpp"
#include "benchmarks/paper/page.hpp"
#include "benchmarks/paper/pendulum.hpp"

namespace hamgen::paper {

struct Study {
  bool quick = false;
  std::filesystem::path data;  // the directory for gnuplot's tables

  // The family with alpha, beta, gamma at run time.
  CompiledScheme member;    // in double, solved to round-off
  CompiledScheme sweeps;    // in double, by the paper's Algorithm 1 with kappa = 5
  CompiledScheme extended;  // in long double, solved to round-off
  CompiledScheme euler_a;
  CompiledScheme euler_b;
  CompiledScheme reference;                // implicit midpoint in quad
  std::vector<CompiledScheme> splittings;  // SABA2 as the paper prints it, and Laskar and Robutel's
  std::vector<CompiledScheme> orders;      // members of order 4, 6, 8, in long double
  std::vector<CompiledScheme>
      timed;  // midpoint with five sweeps, midpoint solved, SABA2: in double

  // The paper: "almost all the results used N = 10^5".
  [[nodiscard]] long steps() const { return quick ? 10'000 : 100'000; }
};

[[nodiscard]] Study make_study(bool quick, const std::filesystem::path& data);

// The pair the paper found, for the orbit from q = 3.1: beta = b h, gamma = c h.
constexpr long double kPaperB = -2.4978136594e-3L;
constexpr long double kPaperC = -8.33321735568e-2L;
[[nodiscard]] inline Gauge paper_pair(long double h) {
  return {.alpha = 0.5L, .beta = kPaperB * h, .gamma = kPaperC * h};
}

// Errors below these are rounding's, in long double: of the energy, and of the state after t = 100.
constexpr double kEnergyFloor = 1e-18;
constexpr double kStateFloor = 1e-15;

[[nodiscard]] inline Gauge gauge_of(const Pair& pair) {
  return {.alpha = 0.5L, .beta = pair.beta, .gamma = pair.gamma};
}

// A table for gnuplot: blocks (`index` there) with a title and rows of numbers.
class DataTable {
 public:
  void block(const std::string& title);
  void row(const std::vector<long double>& values);
  void empty_line();  // between the rows of a grid
  void write(const std::filesystem::path& path) const;

 private:
  std::string text_;
};

// Appends a block "t error" of an orbit, about `points` rows.  Returns the orbit.
Orbit trace(DataTable& data, const std::string& title, const CompiledScheme& scheme,
            const Start& start, long steps, long points);

// One section a figure, or a group of remarks.
[[nodiscard]] Section figure_2(const Study& study);
[[nodiscard]] Section figure_3(const Study& study);
[[nodiscard]] Section large_steps(const Study& study);
[[nodiscard]] Section time_reversal(const Study& study);
[[nodiscard]] Section figure_4(const Study& study);
[[nodiscard]] Section figure_5(const Study& study);
[[nodiscard]] Section figure_6(const Study& study);
[[nodiscard]] Section figures_7_and_8(const Study& study);
[[nodiscard]] Section all_integrators(const Study& study);

}  // namespace hamgen::paper
