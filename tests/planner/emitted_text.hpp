// A model's plan and its emitted text, for tests that look at both.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generator/pipeline.hpp"

namespace hamgen::planner_test {

// What the planner and the emitter made of a model.
struct Outcome {
  std::string plan;    // show --stage plan
  std::string header;  // the emitted header
  std::string solve;   // its function solve: one step's mathematics
};

// "system NAME", then the text.
[[nodiscard]] SourceText model(const std::string& text);
[[nodiscard]] Outcome outcome(const std::string& text, const Request& request = {});

[[nodiscard]] bool contains(std::string_view text, std::string_view part);
[[nodiscard]] int count(std::string_view text, std::string_view part);
// Is there a name in the code (not within a longer name)?  Comments do not count.
[[nodiscard]] bool has_name(std::string_view code, std::string_view name);
// The text from a line that holds `begin` to the next line that is just "}".
[[nodiscard]] std::string function_text(std::string_view header, std::string_view begin);

inline const std::string one = "coordinate q\nmomentum p\n";
inline const std::string two = "coordinate q1, q2\nmomentum p1, p2\n";
inline const std::string double_pendulum =
    two +
    "H = (p1^2 + 2*p2^2 - 2*p1*p2*cos(q1 - q2))/(2*(1 + sin(q1 - q2)^2)) - 2*cos(q1) - cos(q2)\n";

}  // namespace hamgen::planner_test
