// Trajectories of models in batches: what is emitted for them, run, and what it prints.
#pragma once

#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {

using Starts = std::vector<std::pair<double, double>>;

// Trajectories of a model; those of `fails` leave the domain of H or the numbers on the way.
struct BatchCase {
  std::string name;
  std::string model;  // its state has q, p
  Request request;
  double h = 0.1;
  int steps = 200;
  Starts starts = {};  // 8 of them
  int failing = 0;     // of these
  std::vector<int> widths = {1, 2, 4, 8};
  // What starts, of the state, beside which all is as it is by default.
  std::string q = "q", p = "p";
};

void PrintTo(const BatchCase& test, std::ostream* out);

[[nodiscard]] std::vector<BatchCase> explicit_cases();
// Newton's iteration, written out.
[[nodiscard]] std::vector<BatchCase> implicit_cases();
// Fixed points, stages, systems in loops.
[[nodiscard]] std::vector<BatchCase> iterated_cases();
// Every scheme, and every solver of some, for a system that is written out and one in loops.
[[nodiscard]] std::vector<BatchCase> swept_cases();

// A separable H with functions in it.
[[nodiscard]] const char* functions_model();

[[nodiscard]] std::string batch_header(const BatchCase& test, int lanes, const std::string& math);
// What the trajectories come to in batches of so many, a line each.
[[nodiscard]] std::string batch_program(const BatchCase& test, const std::vector<int>& widths,
                                        const std::string& math);
[[nodiscard]] std::vector<std::string> batch_lines(const std::string& text);
[[nodiscard]] long failed_lines(const std::vector<std::string>& lines);

}  // namespace hamgen::emitted_test
