#include "app/output/tune_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/output/generate_command.hpp"
#include "app/output/json_document.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kWorthTuning = 2.0;  // a gain below this is none

std::string_view form_name(GaugeForm form) {
  switch (form) {
    case GaugeForm::scalar:
      return "scalar";
    case GaugeForm::diagonal:
      return "diagonal";
    case GaugeForm::matrix:
      break;
  }
  return "matrix";
}

std::string tune_number(std::optional<double> value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

std::string stability_text(const StabilityBound& bound) {
  if (!bound.known) return "not known";
  return bound.below ? fmt::format("h < {:.4g}", *bound.below) : "every h";
}

// Relative to the energy's scale.
std::string relative_text(const TuneReport& report, std::optional<double> energy) {
  if (!energy || !(report.energy_scale() > 0.0)) return "-";
  return tune_number(*energy / report.energy_scale());
}

template <class Cell>
std::string tune_row(const TuneReport& report, const char* label, const Cell& cell) {
  std::string text = fmt::format("  {:<26}", label);
  for (const TunedGauge& gauge : report.gauges) text += fmt::format("  {:>17}", cell(gauge));
  return text + "\n";
}

std::string tune_failures(const TuneReport& report) {
  std::string text;
  for (const TunedGauge& gauge : report.gauges) {
    if (!gauge.measured.failure.empty())
      text += fmt::format("  {} failed: {}\n", gauge.name, gauge.measured.failure);
  }
  return text;
}

Json tune_json_number(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  return *value;
}

// Where both runs came to their end, and the energy spread is less by that factor, or gone.
bool is_worth_while(const TuneReport& report) {
  const std::optional<double> before = report.gauges.front().measured_spread();
  const std::optional<double> after = report.gauges.back().measured_spread();
  return before && after && *before > report.rounding() && *before >= kWorthTuning * *after;
}

}  // namespace

std::string verdict_of(const TuneReport& report) {
  const TunedGauge& midpoint = report.gauges.front();
  const TunedGauge& best = report.gauges.back();
  if (midpoint.measured_spread().value_or(1.0) <= report.rounding())
    return "nothing to tune: the midpoint rule keeps this energy to rounding";
  const std::optional<double> gain = report.gain();
  if (!best.measured.failure.empty()) return "worth nothing here: the tuned run failed";
  if (!midpoint.measured.failure.empty())
    return "nothing to compare with: the run of the midpoint rule failed";
  const bool worth = is_worth_while(report);
  // Nothing is gained in the energy; the phase may still be better.
  const bool phase = midpoint.state_error && best.state_error &&
                     *midpoint.state_error >= kWorthTuning * *best.state_error;
  std::string text = worth ? "" : phase ? "no flatter: " : "worth nothing here: ";
  if (!gain) text += "the energy spread is gone";
  if (gain && *gain < 1.0) text += "the energy spread does not shrink";
  if (gain && *gain >= 1.0)
    text += fmt::format("the energy spread shrinks by a factor of {:.3g}{}", *gain,
                        worth ? "" : " only");
  if (midpoint.state_error && best.state_error && *midpoint.state_error > 0.0) {
    const double ratio = *best.state_error / *midpoint.state_error;
    text += fmt::format(";\n              the state error {} by a factor of {:.3g}",
                        ratio > 1.0 ? "grows" : "shrinks", std::max(ratio, 1.0 / ratio));
  }
  if (best.stability.below && report.h > *best.stability.below)
    text += ";\n              this h is beyond the bound of its linear part: it may not last";
  return text + (worth ? ";\n              the gauge fits this orbit, not others" : "");
}

std::string tune_text(const TuneReport& report) {
  const GaugeTexts texts = gauge_texts(report.shape, number_texts(report.shown));
  std::string text =
      fmt::format("{}{}: h = {}, t = {} ({} steps)\n", report.model,
                  report.scene.empty() ? "" : ", scene " + report.scene,
                  runtime::number_text(report.h), runtime::number_text(report.time), report.steps);
  text +=
      fmt::format("  fit         {}: {} of {} coefficients determined by {} points of the orbit\n",
                  form_name(report.shape.form), report.rank, report.shape.size(), report.samples);
  text += fmt::format("  beta        {}\n  gamma       {}\n", texts.beta, texts.gamma);
  text +=
      fmt::format("  energies    relative to their scale {}\n", tune_number(report.energy_scale()));
  text += tune_row(report, "", [](const TunedGauge& gauge) { return gauge.name; });
  text += tune_row(report, "energy spread, h^2 term", [&report](const TunedGauge& gauge) {
    return relative_text(report, gauge.predicted_spread);
  });
  text += tune_row(report, "energy spread, measured", [&report](const TunedGauge& gauge) {
    return relative_text(report, gauge.measured_spread());
  });
  text += tune_row(report, "energy error, measured", [&report](const TunedGauge& gauge) {
    return relative_text(report, gauge.measured_error());
  });
  text += tune_row(report, "state error at the end",
                   [](const TunedGauge& gauge) { return tune_number(gauge.state_error); });
  text += tune_row(report, "linear part bounded for",
                   [](const TunedGauge& gauge) { return stability_text(gauge.stability); });
  text += tune_failures(report);
  if (!report.reference_failure.empty())
    text += fmt::format("  no state errors: {}\n", report.reference_failure);
  text += fmt::format("  verdict     {}\n", verdict_of(report));
  if (report.evaluations > 0)
    text +=
        fmt::format("  polished    with {} runs, for this h: another h has other best values{}\n",
                    report.evaluations,
                    report.polish_ended ? ""
                                        : ";\n              stopped there, the most that are "
                                          "allowed: not yet at a minimum");
  return text + fmt::format("  use         for h = {}\n              {}\n",
                            runtime::number_text(report.h),
                            generate_command(report.path, report.request));
}

std::string tune_json(const TuneReport& report) {
  Json gauges = Json::array();
  for (const TunedGauge& gauge : report.gauges) {
    const GaugeTexts texts = gauge_texts(report.shape, number_texts(gauge.coefficients));
    gauges.push_back({{"name", gauge.name},
                      {"beta", texts.beta},
                      {"gamma", texts.gamma},
                      {"predicted_energy_spread", tune_json_number(gauge.predicted_spread)},
                      {"energy_spread", tune_json_number(gauge.measured_spread())},
                      {"energy_error", tune_json_number(gauge.measured_error())},
                      {"state_error", tune_json_number(gauge.state_error)},
                      {"stability_known", gauge.stability.known},
                      {"stable_below", tune_json_number(gauge.stability.below)},
                      {"failure", gauge.measured.failure.empty() ? Json(nullptr)
                                                                 : Json(gauge.measured.failure)}});
  }
  const Json json = {{"model", report.model},
                     {"path", report.path},
                     {"scene", report.scene.empty() ? Json(nullptr) : Json(report.scene)},
                     {"h", report.h},
                     {"time", report.time},
                     {"steps", report.steps},
                     {"form", form_name(report.shape.form)},
                     {"samples", report.samples},
                     {"rank", report.rank},
                     {"initial_energy", report.initial_energy},
                     {"energy_scale", tune_json_number(report.energy_scale())},
                     {"gauges", gauges},
                     {"gain", tune_json_number(report.gain())},
                     {"worth_while", is_worth_while(report)},
                     {"evaluations", report.evaluations},
                     {"polish_ended", report.polish_ended},
                     {"command", generate_command(report.path, report.request)}};
  return json_document(json);
}

}  // namespace hamgen::app
