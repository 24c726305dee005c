#include "app/output/run_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/output/certify_output.hpp"
#include "app/output/json_document.hpp"
#include "app/output/plain_number.hpp"
#include "app/output/summary_entry.hpp"
#include "app/output/wide_text.hpp"
#include "app/studies/initial_data.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

using Json = nlohmann::ordered_json;
using runtime::number_text;

// What the scene made unnecessary, at most about two lines of it; the plan says what it lacks
// itself.
std::string left_out_text(const PluginSource& plugin) {
  const std::size_t count = std::min(plugin.left_out_for_scene, plugin.left_out.size());
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    if (text.size() + plugin.left_out[i].size() > 2 * summary_width && i > 0)
      return text + fmt::format("; and {} more, see hamgen show --stage plan", count - i);
    text += (i == 0 ? "" : "; ") + plugin.left_out[i];
  }
  return text;
}

bool is_wide(const RunReport& report) { return report.scalar_digits > 53; }

// Ten digits of a double, for the eye; all of a wider scalar, which is why it was chosen.
std::string value_text(const RunReport& report, const runtime::Wide& value) {
  return is_wide(report) ? wide_text(value, report.scalar_digits)
                         : fmt::format("{:.10g}", value.hi);
}

// "q[1] = 0.5, q[2] = 1, ...": the variables, of which the first is number `begin` of the state.
std::string numbers(const RunReport& report, const std::vector<Variable>& variables,
                    std::size_t begin) {
  const std::vector<std::string> names = element_names(variables);
  const std::size_t count = std::min(names.size(), report.state.size() - begin);
  const std::size_t largest = is_wide(report) ? 2 : 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(count, largest); ++i) {
    const runtime::Wide& value = report.state[begin + i];
    text += fmt::format("{}{} = {}", i == 0 ? "" : ", ", names[i],
                        std::isnan(value.hi) ? "-" : wide_text(value, report.scalar_digits));
  }
  return count > largest ? text + ", ..." : text;
}

// The time since the start, by its name beside the state's, with its value.
std::string clock(const RunReport& report, double time, int digits = 10) {
  return fmt::format("{} = {:.{}g}", time_column(element_names(report.plugin->model.coordinates)),
                     time, digits);
}

bool has_ended(const RunReport& report) {
  return report.watch != nullptr && report.watch->ending().has_value();
}

// The time of the last state: of the place where the run ended, if one did end it, or after the
// steps done.
double last_time(const RunReport& report) {
  if (has_ended(report)) return report.watch->ending()->second.time;
  return static_cast<double>(report.summary.steps_done) * report.start->h.hi;
}

std::string last_state_text(const RunReport& report) {
  const Model& model = report.plugin->model;
  const double t = last_time(report);
  const std::string q = numbers(report, model.coordinates, 0);
  const std::string p = numbers(report, model.momenta, report.state.size() / 2);
  return fmt::format("{}: {}{}{}", clock(report, t), q, q.empty() || p.empty() ? "" : ", ", p);
}

std::string seconds_text(double seconds) {
  return seconds < 1e-3 ? terminal_number(1e3 * seconds, 2) + " ms"
                        : terminal_number(seconds, 3) + " s";
}

std::string energy_text(const RunReport& report) {
  if (!watches_energy(*report.plugin, *report.scene)) return "not observed";
  if (!report.summary.energy) return "not defined";
  const runtime::EnergyStatistics& energy = *report.summary.energy;
  const double scale = report.summary.energy_terms;
  const std::string relative =
      scale > 0 ? fmt::format(", {:.2g} of the scale {:.3g}", energy.max_error() / scale, scale)
                : "";
  return fmt::format("H(0) = {}; max error {:.5g}{}; spread {:.5g}, last {:.3g}",
                     value_text(report, energy.initial), energy.max_error(), relative,
                     energy.spread(), energy.final_error());
}

std::string time_text(const RunReport& report) {
  std::string compile = report.interpreted  ? "interpreted"
                        : report.from_cache ? "compiled before"
                                            : "compile " + seconds_text(report.compile_seconds);
  if (!report.interpreted && report.optimisation != "-O3")
    compile += fmt::format(" with {}", report.optimisation);
  const std::string rate = terminal_number(report.summary.nanoseconds_per_step(), 3) + " ns/step";
  return fmt::format("generate {}, {}, run {}{}", seconds_text(report.generate_seconds), compile,
                     seconds_text(report.summary.total_seconds),
                     report.summary.steps_done > 0 ? ": " + rate : "");
}

bool is_formula(const std::string& name, const SceneValues& scene) {
  return std::ranges::find(scene.formulas, name, &ObservedFormula::name) != scene.formulas.end();
}

std::string invariant_text(const RunReport& report, std::size_t i) {
  const std::string& name = report.plugin->invariant_names[i];
  const runtime::Wide before = report.initial_invariants[i];
  const runtime::Wide after = report.final_invariants[i];
  if (!std::isfinite(before.hi)) return name + " is not defined at the initial state";
  const std::string text = fmt::format("{} = {}; ", name, value_text(report, before));
  if (!std::isfinite(after.hi)) return text + "not defined at the last state";
  if (is_formula(name, *report.scene)) return text + "last " + value_text(report, after);
  return text + fmt::format("last error {:.3g}", difference(after, before));
}

// JSON has no nan: the status says why a value is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json half(const std::vector<runtime::Wide>& state, bool momenta, double runtime::Wide::*part) {
  Json values = Json::array();
  const std::size_t n = state.size() / 2;
  for (std::size_t i = 0; i < n; ++i) values.push_back(number(state[momenta ? n + i : i].*part));
  return values;
}

Json state_json(const std::vector<runtime::Wide>& state, double time, bool wide) {
  Json result = {{"t", number(time)},
                 {"q", half(state, false, &runtime::Wide::hi)},
                 {"p", half(state, true, &runtime::Wide::hi)}};
  if (wide) {  // q + q_lo has the digits a double cannot hold
    result["q_lo"] = half(state, false, &runtime::Wide::lo);
    result["p_lo"] = half(state, true, &runtime::Wide::lo);
  }
  return result;
}

// A wider scalar's value is that of the key and that of key_lo together.
void put(Json& object, const std::string& key, const runtime::Wide& value, bool wide) {
  object[key] = number(value.hi);
  if (wide) object[key + "_lo"] = number(value.lo);
}

Json energy_json(const RunReport& report) {
  const std::optional<runtime::EnergyStatistics>& energy = report.summary.energy;
  if (!energy)
    return {{"initial", nullptr},   {"scale", nullptr},
            {"max_error", nullptr}, {"max_relative_error", nullptr},
            {"spread", nullptr},    {"final_error", nullptr}};
  Json result;
  put(result, "initial", energy->initial, is_wide(report));
  const double scale = report.summary.energy_terms;
  result["scale"] = scale > 0 ? Json(number(scale)) : Json(nullptr);
  result["max_error"] = number(energy->max_error());
  result["max_relative_error"] =
      scale > 0 ? Json(number(energy->max_error() / scale)) : Json(nullptr);
  result["spread"] = number(energy->spread());
  result["final_error"] = number(energy->final_error());
  return result;
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
    if (is_watched(*report.scene, report.plugin->invariant_names[i])) continue;
    const runtime::Wide before = report.initial_invariants[i];
    const runtime::Wide after = report.final_invariants[i];
    Json& values = result[report.plugin->invariant_names[i]];
    put(values, "initial", before, is_wide(report));
    put(values, "final", after, is_wide(report));
    values["final_error"] = number(difference(after, before));
  }
  for (const Invariant& each : report.plugin->model.invariants) {
    if (!result.contains(each.name)) result[each.name] = nullptr;  // not observed
  }
  return result;
}

std::string ending_text(const RunReport& report) {
  if (!has_ended(report)) return "";
  const auto& [event, point] = *report.watch->ending();
  const EndCondition& what = (*report.events)[event].what;
  if (what.holds)
    return fmt::format("{} holds at {}, after step {}", what.event.text, clock(report, point.time),
                       point.steps);
  return fmt::format("{}: at {}, in step {}", what.event.text, clock(report, point.time, 16),
                     point.steps + (point.fraction > 0.0 ? 1 : 0));
}

Json ending_json(const RunReport& report) {
  if (!has_ended(report)) return nullptr;
  const auto& [event, point] = *report.watch->ending();
  return {{"by", (*report.events)[event].what.event.text},
          {"t", number(point.time)},
          {"steps", point.steps},
          {"fraction", number(point.fraction)}};
}

std::vector<std::string> event_texts(const RunReport& report) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; report.watch != nullptr && i < report.events->size(); ++i) {
    const ModelEvent& event = (*report.events)[i].what.event;
    const Sighting& seen = report.watch->sightings()[i];
    if ((*report.events)[i].ends_run) continue;
    if (seen.count == 0)
      texts.push_back(fmt::format("{}: never; after each step it was between {:.6g} and {:.6g}",
                                  event.name, seen.least, seen.largest));
    else if (seen.count == 1)
      texts.push_back(fmt::format("{}: once, at {}", event.name, clock(report, seen.first, 16)));
    else
      texts.push_back(fmt::format("{}: {} times, from {} to {}", event.name, seen.count,
                                  clock(report, seen.first, 16), clock(report, seen.last, 16)));
  }
  return texts;
}

Json events_json(const RunReport& report) {
  Json result = Json::object();
  for (std::size_t i = 0; report.watch != nullptr && i < report.events->size(); ++i) {
    if ((*report.events)[i].ends_run) continue;
    const Sighting& seen = report.watch->sightings()[i];
    const bool met = seen.count > 0;
    result[(*report.events)[i].what.event.name] = {
        {"count", seen.count},
        {"first", met ? number(seen.first) : Json(nullptr)},
        {"last", met ? number(seen.last) : Json(nullptr)},
        {"min", number(seen.least)},
        {"max", number(seen.largest)}};
  }
  return result;
}

}  // namespace

std::vector<std::string> missed_ends(const RunReport& report) {
  std::vector<std::string> texts;
  if (report.watch == nullptr || has_ended(report)) return texts;
  for (std::size_t i = 0; i < report.events->size(); ++i) {
    const WatchedEvent& each = (*report.events)[i];
    if (!each.ends_run) continue;
    const Sighting& seen = report.watch->sightings()[i];
    const ModelEvent& event = each.what.event;
    const std::string steps = fmt::format("in {} steps", report.summary.steps_done);
    if (each.what.holds) {
      texts.push_back(fmt::format("--until {} never held {}", event.text, steps));
    } else {
      texts.push_back(fmt::format(
          "--until {} never crossed zero {}: after each it was between {:.6g} and {:.6g}",
          event.text, steps, seen.least, seen.largest));
    }
  }
  return texts;
}

std::string failure_text(const RunReport& report) {
  const runtime::RunSummary& summary = report.summary;
  const double h = report.start->h.hi;
  const double t = static_cast<double>(summary.steps_done) * h;
  const long long step = summary.steps_done + 1;
  const std::string increment =
      summary.last_increment ? fmt::format("{:.3g}", *summary.last_increment) : "not finite";
  const std::string where = fmt::format("at {}, h = {}", clock(report, t), number_text(h));
  switch (summary.status) {
    case runtime::Status::done:
    case runtime::Status::undefined:  // a run begins where there are values
      return "";
    case runtime::Status::out_of_time:
      return fmt::format("out of time: {:.6g} s were over after {} of {} steps, at {}",
                         report.seconds.value_or(0.0), summary.steps_done, *report.scene->steps,
                         clock(report, t));
    case runtime::Status::jumped:
      return fmt::format(
          "step {} jumped: {}; the energy error after it, {:.3g}, is more than ten times {:.3g}, "
          "the larger of |H| and |q| |H_q| + |p| |H_p| at the start: it went across a "
          "singularity, or h is far too large",
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
      return fmt::format(
          "step {} overflowed: {}, last increment {}; it met a number beyond the largest, or its "
          "equations have no solution at this h",
          step, where, increment);
    case runtime::Status::stopped:
      return fmt::format("stopped after {} of {} steps, at {}", summary.steps_done,
                         *report.scene->steps, clock(report, t));
  }
  return "";
}

std::string outcome_text(const RunReport& report) {
  const std::string failure = failure_text(report);
  const std::string status(runtime::to_text(report.summary.status));
  if (failure.starts_with(status)) return "status    " + failure;
  return fmt::format("status    {}{}{}", status, failure.empty() ? "" : ": ", failure);
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
  text += summary_entry("solver", solver);
  if (plugin.left_out_for_scene > 0) text += summary_entry("left out", left_out_text(plugin));
  for (const std::string& line : event_texts(report)) text += summary_entry("event", line);
  if (const std::string ending = ending_text(report); !ending.empty())
    text += summary_entry("ended", ending);
  text += summary_entry("energy", energy_text(report));
  for (std::size_t i = 0; i < plugin.invariant_names.size(); ++i) {
    if (is_watched(*report.scene, plugin.invariant_names[i])) continue;
    const bool formula = is_formula(plugin.invariant_names[i], *report.scene);
    text += summary_entry(formula ? "observed" : "invariant", invariant_text(report, i));
  }
  text += summary_entry("last state", last_state_text(report));
  if (report.certificate)
    text += summary_entry("certified", certificate_sentence(*report.certificate));
  text += summary_entry("time", time_text(report));
  if (!report.trajectory.empty()) text += summary_entry("trajectory", report.trajectory);
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
  if (const Json events = events_json(report); !events.empty()) result["events"] = events;
  if (const Json ending = ending_json(report); !ending.is_null()) result["ended"] = ending;
  result["energy"] = energy_json(report);
  result["invariants"] = invariants_json(report);
  result["state"] = state_json(report.state, last_time(report), is_wide(report));
  result["parameters"] = parameters_json(report);
  if (report.certificate) result["certified"] = certificate_json(*report.certificate);
  result["solver"] = {{"kind", report.plugin->solver},
                      {"iterations_per_step", summary.iterations_per_step()},
                      {"left_out", report.plugin->left_out}};
  result["time"] = {
      {"generate_s", report.generate_seconds}, {"compile_s", report.compile_seconds},
      {"run_s", summary.total_seconds},        {"ns_per_step", summary.nanoseconds_per_step()},
      {"from_cache", report.from_cache},       {"interpreted", report.interpreted}};
  if (!report.interpreted) result["time"]["optimisation"] = report.optimisation;
  return json_document(result);
}

}  // namespace hamgen::app
