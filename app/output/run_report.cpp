#include "app/output/run_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/output/json_document.hpp"
#include "app/studies/initial_data.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

using Json = nlohmann::ordered_json;
using runtime::number_text;

constexpr std::size_t line_width = 96;

// "  solver      text ...", wrapped under the text.
std::string entry(std::string_view label, const std::string& text) {
  constexpr std::size_t indent = 14;
  std::string result = fmt::format("  {:<{}}", label, indent - 2);
  std::size_t column = indent;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (column > indent && column + 1 + word.size() > line_width) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
    begin = end + 1;
  }
  return result + "\n";
}

// At most about two lines of them.
std::string left_out_text(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (text.size() + items[i].size() > 2 * line_width && i > 0)
      return text + fmt::format("; and {} more, see hamgen show --stage plan", items.size() - i);
    text += (i == 0 ? "" : "; ") + items[i];
  }
  return text;
}

std::string numbers(const std::vector<runtime::Wide>& state, std::size_t begin, std::size_t end) {
  constexpr std::size_t largest = 4;
  std::string text;
  for (std::size_t i = begin; i < std::min(end, begin + largest); ++i)
    text += (i == begin ? "" : ", ") + (std::isnan(state[i].hi) ? "-" : number_text(state[i].hi));
  return end > begin + largest ? text + ", ..." : text;
}

std::string seconds_text(double seconds) {
  return seconds < 1e-3 ? fmt::format("{:.2g} ms", 1e3 * seconds)
                        : fmt::format("{:.3g} s", seconds);
}

std::string energy_text(const RunReport& report) {
  if (!watches_energy(*report.plugin, *report.scene)) return "not observed";
  if (!report.summary.energy) return "not defined";
  const runtime::EnergyStatistics& energy = *report.summary.energy;
  return fmt::format("H(0) = {:.10g}; max error {:.5g}, spread {:.5g}, last {:.3g}", energy.initial,
                     energy.max_error(), energy.spread(), energy.final_error());
}

std::string time_text(const RunReport& report) {
  const std::string compile = report.interpreted ? "interpreted"
                              : report.from_cache
                                  ? "compiled before"
                                  : "compile " + seconds_text(report.compile_seconds);
  return fmt::format(
      "generate {}, {}, run {}: {:.3g} ns/step", seconds_text(report.generate_seconds), compile,
      seconds_text(report.summary.total_seconds), report.summary.nanoseconds_per_step());
}

std::string invariant_text(const std::string& name, double before, double after, bool conserved) {
  if (!std::isfinite(before)) return name + " is not defined at the initial state";
  const std::string text = fmt::format("{} = {:.10g}; ", name, before);
  if (!std::isfinite(after)) return text + "not defined at the last state";
  return text + (conserved ? fmt::format("last error {:.3g}", after - before)
                           : fmt::format("last {:.10g}", after));
}

bool is_formula(const std::string& name, const SceneValues& scene) {
  return std::ranges::find(scene.formulas, name, &ObservedFormula::name) != scene.formulas.end();
}

// JSON has no nan: the status says why a value is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json half(const std::vector<runtime::Wide>& state, bool momenta, double runtime::Wide::*part) {
  Json values = Json::array();
  const std::size_t n = state.size() / 2;
  for (std::size_t i = 0; i < n; ++i) values.push_back(number(state[momenta ? n + i : i].*part));
  return values;
}

Json state_json(const std::vector<runtime::Wide>& state, bool wide) {
  Json result = {{"q", half(state, false, &runtime::Wide::hi)},
                 {"p", half(state, true, &runtime::Wide::hi)}};
  if (wide) {  // q + q_lo has the digits a double cannot hold
    result["q_lo"] = half(state, false, &runtime::Wide::lo);
    result["p_lo"] = half(state, true, &runtime::Wide::lo);
  }
  return result;
}

Json energy_json(const runtime::RunSummary& summary) {
  if (!summary.energy)
    return {{"initial", nullptr},
            {"max_error", nullptr},
            {"spread", nullptr},
            {"final_error", nullptr}};
  return {{"initial", number(summary.energy->initial)},
          {"max_error", number(summary.energy->max_error())},
          {"spread", number(summary.energy->spread())},
          {"final_error", number(summary.energy->final_error())}};
}

Json parameters_json(const RunReport& report) {
  Json result = Json::object();
  for (const auto& [name, value] : parameter_values(*report.plugin, *report.scene, *report.start))
    result[name] = number(value);
  return result;
}

Json invariants_json(const RunReport& report) {
  Json result = Json::object();
  for (std::size_t i = 0; i < report.plugin->invariant_names.size(); ++i) {
    const double before = report.initial_invariants[i];
    const double after = report.final_invariants[i];
    result[report.plugin->invariant_names[i]] = {{"initial", number(before)},
                                                 {"final", number(after)},
                                                 {"final_error", number(after - before)}};
  }
  for (const Invariant& each : report.plugin->model.invariants) {
    if (!result.contains(each.name)) result[each.name] = nullptr;  // not observed
  }
  return result;
}

}  // namespace

std::string failure_text(const RunReport& report) {
  const runtime::RunSummary& summary = report.summary;
  const double h = report.start->h.hi;
  const double t = static_cast<double>(summary.steps_done) * h;
  const long long step = summary.steps_done + 1;
  const std::string increment =
      summary.last_increment ? fmt::format("{:.3g}", *summary.last_increment) : "not finite";
  const std::string where = fmt::format("at t = {:.10g}, h = {}", t, number_text(h));
  switch (summary.status) {
    case runtime::Status::done:
    case runtime::Status::out_of_time:  // a run has no limits of time,
    case runtime::Status::undefined:    // and begins where there are values
      return "";
    case runtime::Status::jumped:
      return fmt::format(
          "step {} jumped: {}; the energy error after it, {:.3g}, is more than ten times the "
          "energy "
          "scale of the start, {:.3g}: it went across a singularity, or h is far too large",
          step, where, summary.jump.value_or(0.0), summary.energy_scale);
    case runtime::Status::escaped:
      return fmt::format(
          "step {} failed far away: {}, more than 1000 times farther than at the start and the "
          "energy kept: the orbit escapes, perhaps to infinity in finite time",
          step, where);
    case runtime::Status::not_converged:
      return fmt::format("step {} did not converge: {}, {} iterations, last increment {}", step,
                         where, summary.last_iterations, increment);
    case runtime::Status::left_domain:
      return fmt::format(
          "step {} left the domain of H: {}, last increment {}; it met a state where H or its "
          "gradient is not a finite number",
          step, where, increment);
    case runtime::Status::overflow:
      return fmt::format("step {} overflowed: {}, last increment {}", step, where, increment);
    case runtime::Status::stopped:
      return fmt::format("stopped after {} of {} steps, at t = {:.10g}", summary.steps_done,
                         *report.scene->steps, t);
  }
  return "";
}

std::string outcome_text(const RunReport& report) {
  const std::string failure = failure_text(report);
  return fmt::format("status    {}{}{}", runtime::to_text(report.summary.status),
                     failure.empty() ? "" : ": ", failure);
}

std::string summary_text(const RunReport& report) {
  const PluginSource& plugin = *report.plugin;
  const runtime::RunSummary& summary = report.summary;
  std::string text = fmt::format("{}{}: {}, h = {}, {} of {} steps\n", plugin.model.name,
                                 report.scene->name.empty() ? "" : ", scene " + report.scene->name,
                                 plugin.scheme_name, number_text(report.start->h.hi),
                                 summary.steps_done, *report.scene->steps);
  std::string solver = plugin.solver;
  if (summary.iterations > 0)
    solver += fmt::format("; {:.3g} iterations/step", summary.iterations_per_step());
  text += entry("solver", solver);
  if (!plugin.left_out.empty()) text += entry("left out", left_out_text(plugin.left_out));
  text += entry("energy", energy_text(report));
  for (std::size_t i = 0; i < plugin.invariant_names.size(); ++i) {
    const std::string& name = plugin.invariant_names[i];
    const bool formula = is_formula(name, *report.scene);
    text += entry(
        formula ? "observed" : "invariant",
        invariant_text(name, report.initial_invariants[i], report.final_invariants[i], !formula));
  }
  const std::size_t n = report.state.size() / 2;
  text += entry("last q", numbers(report.state, 0, n));
  text += entry("last p", numbers(report.state, n, 2 * n));
  text += entry("time", time_text(report));
  if (!report.trajectory.empty()) text += entry("trajectory", report.trajectory);
  // It may be a command, to be pasted: not wrapped.
  return text + fmt::format("  {:<12}{}\n", "header", report.header);
}

std::string json_text(const RunReport& report) {
  const runtime::RunSummary& summary = report.summary;
  Json result = {{"model", report.plugin->model.name},
                 {"path", report.path},
                 {"scene", report.scene->name.empty() ? Json(nullptr) : Json(report.scene->name)},
                 {"scheme", report.plugin->scheme_name},
                 {"h", number(report.start->h.hi)},
                 {"steps", *report.scene->steps},
                 {"steps_done", summary.steps_done},
                 {"status", runtime::to_text(summary.status)}};
  if (summary.status != runtime::Status::done) result["reason"] = failure_text(report);
  result["energy"] = energy_json(summary);
  result["invariants"] = invariants_json(report);
  const bool wide = std::ranges::any_of(report.state, [](const auto& x) { return x.lo != 0.0; });
  result["state"] = state_json(report.state, wide);
  result["parameters"] = parameters_json(report);
  result["solver"] = {{"kind", report.plugin->solver},
                      {"iterations_per_step", summary.iterations_per_step()},
                      {"left_out", report.plugin->left_out}};
  result["time"] = {
      {"generate_s", report.generate_seconds}, {"compile_s", report.compile_seconds},
      {"run_s", summary.total_seconds},        {"ns_per_step", summary.nanoseconds_per_step()},
      {"from_cache", report.from_cache},       {"interpreted", report.interpreted}};
  return json_document(result);
}

}  // namespace hamgen::app
