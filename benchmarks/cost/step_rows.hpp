// The rows of the cost table that are steps: a model, its step as `hamgen run` makes it, and what
// is written by hand for it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "generator/pipeline.hpp"

namespace hamgen::cost_table {

// A step written by hand.  `iterations` of its fixed point, if it is one.
struct HandRow {
  using Values = std::vector<double>;

  int iterations = 0;  // as somebody chose who looked at the result
  // Takes so many steps from the start, and says how long they took [s].
  std::function<double(const Values& start, double h, int iterations, long steps)> seconds;
  // How far steps are from the solutions of their equations; see lack_of.  Empty: they solve them.
  std::function<double(const Values& start, double h, int iterations, long steps)> lack = {};
};

struct StepRow {
  std::string name;
  std::string source;  // a shipped model's file, or the text of one
  std::string scene;
  Request request;
  long steps;
  std::optional<HandRow> hand;
  std::vector<std::string> peers;     // of other libraries, see benchmarks/peers
  std::optional<std::string> h = {};  // else the scene's
};

[[nodiscard]] std::vector<StepRow> step_rows();

}  // namespace hamgen::cost_table
