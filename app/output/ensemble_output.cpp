#include "app/output/ensemble_output.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/output/json_document.hpp"

namespace hamgen::app {

void add(EnsembleSummary& summary, const std::vector<EnsembleRow>& rows, std::size_t energy_error) {
  for (const EnsembleRow& row : rows) {
    ++summary.count;
    summary.steps += row.steps;
    ++summary.ended.at(static_cast<std::size_t>(row.status));
    if (row.status != runtime::Status::done || energy_error >= row.values.size()) continue;
    const double error = row.values[energy_error];
    const double scale = row.values[energy_error + 1];
    summary.largest_error = std::max(summary.largest_error, error);
    if (scale > 0.0) {
      summary.largest_relative_error = std::max(summary.largest_relative_error, error / scale);
    } else {
      summary.has_scale = false;
    }
  }
}

std::string endings_text(const EnsembleSummary& summary) {
  std::string text;
  for (std::size_t i = 0; i < summary.ended.size(); ++i) {
    if (summary.ended[i] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", summary.ended[i],
                        runtime::to_text(static_cast<runtime::Status>(i)));
  }
  return text;
}

std::string ensemble_text(const EnsembleSummary& summary, const EnsembleTitle& title) {
  std::string text = fmt::format(
      "{}{}: {} trajectories over {}\n  scheme     {}, h = {:.10g}, {} steps\n  ended      {}\n",
      title.model, title.scene.empty() ? "" : ", scene " + title.scene, summary.count,
      fmt::join(title.varied, ", "), title.scheme, title.h, title.steps, endings_text(summary));
  if (title.watches_energy && summary.ended[0] > 0)
    text +=
        summary.has_scale
            ? fmt::format("  energy     largest |H - H(0)| {:.1e} of its scale, of those done\n",
                          summary.largest_relative_error)
            : fmt::format("  energy     largest |H - H(0)| {:.1e}, of those done\n",
                          summary.largest_error);
  if (title.done_before > 0)
    text += fmt::format("  resumed    {} of them were there\n", title.done_before);
  if (title.spoilt > 0)
    text += fmt::format("  spoilt     {} records of the parts; done again\n", title.spoilt);
  return text + fmt::format("  results    {}\n", title.output);
}

std::string ensemble_json(const EnsembleSummary& summary, const EnsembleTitle& title) {
  nlohmann::ordered_json ended = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < summary.ended.size(); ++i) {
    if (summary.ended[i] > 0)
      ended[std::string(runtime::to_text(static_cast<runtime::Status>(i)))] = summary.ended[i];
  }
  nlohmann::ordered_json json = {{"model", title.model},
                                 {"scene", title.scene},
                                 {"scheme", title.scheme},
                                 {"h", title.h},
                                 {"steps", title.steps},
                                 {"varied", title.varied},
                                 {"trajectories", summary.count},
                                 {"steps_of_all", summary.steps},
                                 {"ended", ended}};
  if (title.watches_energy) {
    json["max_energy_error"] = summary.steps > 0 ? nlohmann::ordered_json(summary.largest_error)
                                                 : nlohmann::ordered_json(nullptr);
    json["max_relative_energy_error"] = summary.has_scale
                                            ? nlohmann::ordered_json(summary.largest_relative_error)
                                            : nlohmann::ordered_json(nullptr);
  }
  json["columns"] = title.columns;
  json["output"] = title.output;
  return json_document(json);
}

}  // namespace hamgen::app
