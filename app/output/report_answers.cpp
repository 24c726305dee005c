#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/output/generate_command.hpp"
#include "app/output/math_markup.hpp"
#include "app/output/math_symbol.hpp"
#include "app/output/math_text.hpp"
#include "app/output/plain_number.hpp"
#include "app/output/report_parts.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

const Finding* finding(const Proof& proof, const std::string& property) {
  const auto found = std::ranges::find(proof, property, &Finding::property);
  return found == proof.end() ? nullptr : &*found;
}

std::string with_verdict(const std::string& claim, const Finding& found) {
  return claim + " " + verdict_markup(found.verdict);
}

// "alpha = 1/2, beta = 0" is a formula.
std::string scheme_markup(const std::string& name) {
  return name.find('=') == std::string::npos ? html_text(name) : math_prose("`" + name + "`");
}

std::string method_answer(const ReportContent& content) {
  const PluginSource& plugin = *content.plugin;
  const std::string order = fmt::format("order {}", plugin.order);
  const Finding* const proved = finding(content.proof, order);
  const Finding* const symmetric = finding(content.proof, "symmetric");
  std::string text = fmt::format("<strong>{}</strong>, {}", scheme_markup(plugin.scheme_name),
                                 proved != nullptr ? with_verdict(order, *proved) : order);
  if (symmetric != nullptr) text += ", " + with_verdict("symmetric", *symmetric);
  return text + "; " + named_value("h", to_double(*content.scene->h), 6);
}

std::string conserved_answer(const ReportContent& content) {
  std::vector<std::string> parts;
  if (const Finding* const symplectic = finding(content.proof, "symplectic"))
    parts.push_back(with_verdict("the symplectic form", *symplectic));
  for (const Finding& each : content.proof) {
    if (!each.property.ends_with(kConserved)) continue;
    const std::string name = each.property.substr(0, each.property.size() - kConserved.size());
    parts.push_back(with_verdict(inline_formula(math_markup(math_variable(name))), each));
  }
  return parts.empty() ? "nothing is known" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string energy_phrase(const OrbitSummary& orbit) {
  if (!orbit.run.energy) return "";
  const double error = orbit.run.energy->max_error();
  const double scale = orbit.run.energy_terms;
  if (!(scale > 0.0)) return fmt::format("energy to {}", html_number(error, 2));
  return fmt::format("energy to <strong>{}</strong> of its scale {}", html_number(error / scale, 2),
                     html_number(scale, 3));
}

std::string reached_answer(const ReportContent& content) {
  const OrbitSummary& orbit = content.orbit;
  std::string text = energy_phrase(orbit);
  text += fmt::format(" over {} steps", orbit.run.steps_done);
  if (orbit.outcome != "done")
    text += fmt::format(", then <span class='refuted'>it ended early: {}</span>",
                        html_text(orbit.outcome));
  const BenchRow& row = content.row;
  if (row.q_error && row.p_error)
    text += fmt::format("; at {}, {} to {} and {} to {}", named_value("t", content.bench->time, 4),
                        inline_formula(math_symbol("q")), html_number(*row.q_error, 2),
                        inline_formula(math_symbol("p")), html_number(*row.p_error, 2));
  if (row.samples.empty()) return text;
  const BenchTime time = time_of(row);
  return text + fmt::format("; {} a step, {} for a unit of time",
                            html_seconds(1e-9 * time.nanoseconds_per_step),
                            html_seconds(time.seconds_per_time));
}

// The row that comes nearest to the error where none reaches it.
std::string nearest_text(const Bench& bench) {
  const BenchRow* best = nullptr;
  for (const BenchRow& row : bench.rows) {
    const auto error = error_of(row, bench.observed);
    if (error && (best == nullptr || *error < *error_of(*best, bench.observed))) best = &row;
  }
  if (best == nullptr) return "no method of the comparison got through";
  return fmt::format("none of the methods compared reaches it; {} comes to {} with {}",
                     html_text(bench.methods[best->method].spec),
                     html_number(*error_of(*best, bench.observed), 2),
                     named_value("h", to_double(best->h), 4));
}

std::string advice_answer(const ReportContent& content) {
  const Bench& bench = *content.bench;
  const BenchAnswer& answer = bench.answers.front();
  if (!answer.row) return nearest_text(bench);
  const BenchRow& row = bench.rows[*answer.row];
  const BenchMethod& method = bench.methods[row.method];
  return fmt::format(
      "take <strong>{}</strong> with <span class='value'>{}:</span> {} for a unit of time"
      "<br>{}",
      html_text(method.spec), named_value("h", to_double(row.h), 4),
      html_seconds(time_of(row).seconds_per_time),
      command_markup(run_command(content.file, method.request, row.h, row.steps)));
}

std::string left_out_answer(const PluginSource& plugin) {
  constexpr std::size_t most = 6;
  const std::size_t count = std::min(plugin.left_out_for_scene, plugin.left_out.size());
  std::string text;
  for (std::size_t i = 0; i < std::min(count, most); ++i)
    text += (text.empty() ? "" : "; ") + html_text(greek_text(plugin.left_out[i]));
  if (count > most) text += fmt::format("; and {} more", count - most);
  return text.empty() ? "nothing: the scene needs all of the model" : text;
}

}  // namespace

std::string report_answers(const ReportContent& content) {
  std::string text = "<dl class='answers'>\n";
  const auto line = [&text](const std::string& name, const std::string& answer) {
    text += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, answer);
  };
  line("Method", method_answer(content));
  line("Conserves", conserved_answer(content));
  line("Reached", reached_answer(content));
  line(fmt::format("For {} {} error {}", content.bench->observed == Observed::energy ? "an" : "a",
                   to_text(content.bench->observed),
                   html_number(content.bench->answers.front().target, 2)),
       advice_answer(content));
  line("Left out", left_out_answer(*content.plugin));
  return text + "</dl>\n";
}

}  // namespace hamgen::app
