#include "app/output/stress_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "app/output/json_document.hpp"
#include "generator/base/quoted_text.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

// A digit d says an error of about 10^-d of its scale, + more than a tenth of it.
char digit_of(double error, double scale) {
  if (error == 0.0) return '*';
  const double digits = -std::log10(error / scale);
  if (!(digits >= 1.0)) return '+';
  return digits >= 10.0 ? '*' : static_cast<char>('0' + static_cast<int>(digits));
}

char energy_mark(const StressCell& cell) {
  switch (cell.outcome) {
    case runtime::Status::done:
      break;
    case runtime::Status::jumped:
      return 'j';
    case runtime::Status::escaped:
      return 'e';
    case runtime::Status::not_converged:
      return 'n';
    case runtime::Status::left_domain:
      return 'd';
    case runtime::Status::overflow:
      return 'o';
    case runtime::Status::stopped:
      return 's';
    case runtime::Status::out_of_time:
      return 't';
    case runtime::Status::undefined:
      return 'u';
  }
  return digit_of(cell.energy_error, cell.energy_scale);
}

// A point where the state error is not known.
char state_mark(const StressCell& cell) {
  return cell.state_error ? digit_of(*cell.state_error, cell.state_scale) : '.';
}

using Mark = char (*)(const StressCell&);

std::string rows_text(const StressMap& map, Mark mark) {
  std::string text;
  for (std::size_t row = 0; row < map.rows(); ++row) {
    std::string line;
    for (std::size_t column = 0; column < map.columns(); ++column)
      line += mark(map.cells[row * map.columns() + column]);
    const std::string label =
        map.axes.size() > 1 ? fmt::format("{:.4g}", map.axes[1].values[row]) : "";
    text += fmt::format("  {:>10}  {}\n", label, line);
  }
  return text;
}

// The second map, unless all of it is unknown.
std::string states_text(const StressMap& map) {
  const auto known = std::ranges::count_if(
      map.cells, [](const StressCell& cell) { return cell.state_error.has_value(); });
  std::string text = fmt::format("  state error {}; known in {} of {} cells\n", map.references,
                                 known, map.cells.size());
  return known == 0 ? text : text + rows_text(map, state_mark);
}

// Each reason why cells are undefined, once.
std::string reasons_text(const StressMap& map) {
  std::set<std::string> reasons;
  for (const StressCell& cell : map.cells) {
    if (!cell.reason.empty()) reasons.insert(cell.reason);
  }
  std::string text;
  for (const std::string& reason : reasons) text += fmt::format("    {}\n", reason);
  return text;
}

std::string axis_text(const StressAxis& axis) {
  return fmt::format("{} from {:.4g} to {:.4g}{}{}", axis.label, axis.values.front(),
                     axis.values.back(), axis.label == "h" ? " steps of the scene" : "",
                     axis.logarithmic ? ", logarithmic" : "");
}

bool was_run(const StressCell& cell) { return cell.outcome != runtime::Status::undefined; }

// Empty of what was not run.
std::optional<double> error_if_run(const StressCell& cell) {
  return was_run(cell) ? std::optional(cell.energy_error) : std::nullopt;
}

std::optional<double> scale_if_run(const StressCell& cell) {
  return was_run(cell) ? std::optional(cell.energy_scale) : std::nullopt;
}

// Empty where the run ended before it could tell.
std::optional<bool> bounded_to_the_end(const StressCell& cell) {
  if (!cell.bounded) return was_run(cell) ? std::optional(false) : std::nullopt;
  switch (cell.outcome) {
    case runtime::Status::done:
    case runtime::Status::jumped:
    case runtime::Status::escaped:
      return true;
    case runtime::Status::not_converged:
    case runtime::Status::left_domain:
    case runtime::Status::overflow:
    case runtime::Status::stopped:
    case runtime::Status::out_of_time:
    case runtime::Status::undefined:
      return std::nullopt;
  }
  return std::nullopt;
}

std::string_view bounded_text(const StressCell& cell) {
  const std::optional<bool> bounded = bounded_to_the_end(cell);
  return !bounded ? "" : *bounded ? "yes" : "no";
}

std::string number_or_empty(const std::optional<double>& value) {
  return value ? runtime::number_text(*value) : "";
}

nlohmann::ordered_json number_or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? nlohmann::ordered_json(*value)
                                        : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string stress_text(const StressMap& map) {
  std::string text = fmt::format("{}{}: {}, {} cells of at most {} steps\n", map.model,
                                 map.scene.empty() ? "" : ", scene " + map.scene, map.method,
                                 map.cells.size(), map.steps);
  text += "  across      " + axis_text(map.axes[0]) + "\n";
  if (map.axes.size() > 1) text += "  down        " + axis_text(map.axes[1]) + "\n";
  text += "  energy      digits: error 10^-d of its scale; * below 1e-10, + above 0.1\n";
  text += rows_text(map, energy_mark);
  constexpr std::array<char, runtime::kStatuses> marks = {'.', 'j', 'e', 'n', 'd',
                                                          'o', 's', 't', 'u'};
  for (int i = 0; i < runtime::kStatuses; ++i) {
    const auto outcome = static_cast<runtime::Status>(i);
    const auto count = std::ranges::count(map.cells, outcome, &StressCell::outcome);
    if (count == 0) continue;
    text += fmt::format("  {:<15} {} {:5}\n", runtime::to_text(outcome),
                        outcome == runtime::Status::done ? ' ' : marks[static_cast<std::size_t>(i)],
                        count);
    if (outcome == runtime::Status::undefined) text += reasons_text(map);
  }
  int median = 0;
  int most = 0;
  for (const StressCell& cell : map.cells) {
    median = std::max(median, cell.iterations_median);
    most = std::max(most, cell.iterations_max);
  }
  return text +
         fmt::format(
             "  iterations a step: at most {} in the median of a cell, {} in one "
             "step\n",
             median, most) +
         states_text(map);
}

std::string stress_csv(const StressMap& map) {
  std::string text = map.axes[0].label;
  if (map.axes.size() > 1) text += "," + map.axes[1].label;
  text +=
      ",step_size,steps_done,outcome,bounded,energy_error,energy_scale,iterations_median,"
      "iterations_max,h_omega,linear_bounded,state_error,state_scale,state_missing,reason\n";
  for (const StressCell& cell : map.cells) {
    text += runtime::number_text(cell.at[0]);
    if (map.axes.size() > 1) text += "," + runtime::number_text(cell.at[1]);
    text += fmt::format(",{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", number_or_empty(cell.h),
                        cell.steps_done, runtime::to_text(cell.outcome), bounded_text(cell),
                        number_or_empty(error_if_run(cell)), number_or_empty(scale_if_run(cell)),
                        cell.iterations_median, cell.iterations_max, number_or_empty(cell.h_omega),
                        cell.linear_bounded ? (*cell.linear_bounded ? "yes" : "no") : "",
                        number_or_empty(cell.state_error),
                        cell.state_error ? runtime::number_text(cell.state_scale) : "",
                        runtime::csv_cell(visible_text(cell.state_missing)),
                        runtime::csv_cell(visible_text(cell.reason)));
  }
  return text;
}

std::string stress_json(const StressMap& map) {
  nlohmann::ordered_json cells = nlohmann::ordered_json::array();
  for (const StressCell& cell : map.cells) {
    nlohmann::ordered_json at;
    for (std::size_t axis = 0; axis < map.axes.size(); ++axis)
      at[map.axes[axis].label] = cell.at[axis];
    const std::optional<bool> bounded = bounded_to_the_end(cell);
    cells.push_back(
        {{"at", at},
         {"h", number_or_null(cell.h)},
         {"steps_done", cell.steps_done},
         {"outcome", runtime::to_text(cell.outcome)},
         {"bounded", bounded ? nlohmann::ordered_json(*bounded) : nlohmann::ordered_json(nullptr)},
         {"energy_error", number_or_null(error_if_run(cell))},
         {"energy_scale", number_or_null(scale_if_run(cell))},
         {"iterations_median", cell.iterations_median},
         {"iterations_max", cell.iterations_max},
         {"h_omega", number_or_null(cell.h_omega)},
         {"linear_bounded", cell.linear_bounded ? nlohmann::ordered_json(*cell.linear_bounded)
                                                : nlohmann::ordered_json(nullptr)},
         {"state_error", number_or_null(cell.state_error)},
         {"state_scale", cell.state_error ? nlohmann::ordered_json(cell.state_scale)
                                          : nlohmann::ordered_json(nullptr)},
         {"state_missing", cell.state_error ? nlohmann::ordered_json(nullptr)
                                            : nlohmann::ordered_json(cell.state_missing)},
         {"reason", cell.reason.empty() ? nlohmann::ordered_json(nullptr)
                                        : nlohmann::ordered_json(cell.reason)}});
  }
  const nlohmann::ordered_json json = {
      {"model", map.model}, {"scene", map.scene},           {"method", map.method},
      {"steps", map.steps}, {"references", map.references}, {"compiler", map.compiler},
      {"cells", cells}};
  return json_document(json);
}

}  // namespace hamgen::app
