// The report as values, for programs.
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/output/generate_command.hpp"
#include "app/output/json_document.hpp"
#include "app/output/report_page.hpp"

namespace hamgen::app {
namespace {

using ReportJson = nlohmann::ordered_json;

ReportJson finite_or_null(double value) {
  return std::isfinite(value) ? ReportJson(value) : ReportJson(nullptr);
}

ReportJson or_null(const std::optional<double>& value) {
  return value ? finite_or_null(*value) : ReportJson(nullptr);
}

ReportJson proof_json(const Proof& proof) {
  ReportJson list = ReportJson::array();
  for (const Finding& each : proof)
    list.push_back({{"property", each.property},
                    {"verdict", to_text(each.verdict)},
                    {"detail", each.plain()}});
  return list;
}

ReportJson reached_json(const ReportContent& content) {
  const runtime::RunSummary& run = content.orbit.run;
  ReportJson result = {{"steps_done", run.steps_done}, {"outcome", content.orbit.outcome}};
  if (run.energy)
    result["energy"] = {
        {"initial", finite_or_null(run.energy->initial.hi)},
        {"scale", finite_or_null(run.energy_terms)},
        {"max_error", finite_or_null(run.energy->max_error())},
        {"max_relative_error", run.energy_terms > 0.0
                                   ? finite_or_null(run.energy->max_error() / run.energy_terms)
                                   : ReportJson(nullptr)}};
  const BenchRow& row = content.row;
  result["after"] = {{"t", content.bench->time},
                     {"q_error", or_null(row.q_error)},
                     {"p_error", or_null(row.p_error)}};
  if (!row.samples.empty()) {
    const BenchTime time = time_of(row);
    result["time"] = {{"ns_per_step", time.nanoseconds_per_step},
                      {"s_per_time", time.seconds_per_time},
                      {"spread", time.spread}};
  }
  return result;
}

ReportJson answers_json(const ReportContent& content) {
  const Bench& bench = *content.bench;
  ReportJson list = ReportJson::array();
  for (const BenchAnswer& answer : bench.answers) {
    ReportJson entry = {{"observe", to_text(bench.observed)}, {"target", answer.target}};
    if (answer.row) {
      const BenchRow& row = bench.rows[*answer.row];
      const BenchMethod& method = bench.methods[row.method];
      entry["scheme"] = method.spec;
      entry["h"] = to_double(row.h);
      entry["s_per_time"] = time_of(row).seconds_per_time;
      entry["command"] = run_command(content.path, method.request, row.h, row.steps);
    } else {
      entry["scheme"] = nullptr;
    }
    list.push_back(entry);
  }
  return list;
}

}  // namespace

std::string report_json(const ReportContent& content, const std::string& directory) {
  ReportJson figures = ReportJson::array();
  for (const ReportPicture& picture : content.pictures)
    figures.push_back(
        {{"name", picture.name}, {"caption", picture.caption}, {"drawn", !picture.svg.empty()}});
  Proof linear;
  for (const LinearPoint& point : content.linear) {
    for (Finding& each : findings(point)) linear.push_back(std::move(each));
  }
  const PluginSource& plugin = *content.plugin;
  return json_document({{"model", plugin.model.name},
                        {"path", content.path},
                        {"scene", content.scene->name.empty() ? ReportJson(nullptr)
                                                              : ReportJson(content.scene->name)},
                        {"directory", directory},
                        {"page", "report.html"},
                        {"scheme", plugin.scheme_name},
                        {"order", plugin.order},
                        {"h", to_double(*content.scene->h)},
                        {"solver", plugin.solver},
                        {"left_out", plugin.left_out},
                        {"reached", reached_json(content)},
                        {"answers", answers_json(content)},
                        {"proof", proof_json(content.proof)},
                        {"linear", proof_json(linear)},
                        {"figures", figures}});
}

}  // namespace hamgen::app
