// What the report says of errors against run time, in tables.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/output/generate_command.hpp"
#include "app/output/plain_number.hpp"
#include "app/output/report_parts.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

std::string error_number(const std::optional<double>& value) {
  return value ? html_number(*value, 3) : "–";
}

std::string number_cell(const std::string& text) { return "<td class='number'>" + text + "</td>"; }

// 0.01 stands among powers of ten.
std::string target_number(double target) {
  const double exponent = std::log10(target);
  if (std::fabs(exponent - std::round(exponent)) > 1e-9) return html_number(target, 2);
  return inline_formula(power_of(math_number("10"), math_number(fmt::format("{:.0f}", exponent))));
}

std::string row_text(const Bench& bench, const BenchRow& row, bool is_in_front) {
  const std::string begin = fmt::format(
      "<tr{}><td class='name'>{}</td>{}", is_in_front ? " class='front'" : "",
      html_text(bench.methods[row.method].spec), number_cell(html_number(to_double(row.h), 4)));
  if (!row.ok()) return begin + "<td colspan='8'>" + html_text(row.outcome) + "</td></tr>\n";
  const BenchTime time = time_of(row);
  const auto count = [](double value) {
    return value > 0.0 ? html_number(value, 3) : std::string("–");
  };
  return begin + number_cell(fmt::format("{:.0f}", time.nanoseconds_per_step)) +
         number_cell(html_number(1e6 * time.seconds_per_time, 3)) +
         number_cell(fmt::format("{:.0f} %", 100.0 * time.spread)) +
         number_cell(count(row.iterations_per_step)) + number_cell(count(row.gradients_per_step)) +
         number_cell(error_number(row.relative_energy_error())) +
         number_cell(error_number(row.q_error)) + number_cell(error_number(row.p_error)) +
         "</tr>\n";
}

}  // namespace

std::string bench_table(const Bench& bench) {
  const std::vector<std::size_t> front = pareto_front(bench.rows, bench.observed);
  std::string text =
      "<div class='wide' tabindex='0'><table>\n<tr><th>method</th><th class='number'>h</th>"
      "<th class='number'>ns/step</th><th class='number'>µs/unit time</th>"
      "<th class='number'>±</th><th class='number'>iterations</th>"
      "<th class='number'>gradients</th><th class='number'>energy error</th>"
      "<th class='number'>q error</th><th class='number'>p error</th></tr>\n";
  for (std::size_t i = 0; i < bench.rows.size(); ++i)
    text += row_text(bench, bench.rows[i], std::ranges::find(front, i) != front.end());
  return text +
         fmt::format(
             "</table></div>\n<p class='note'>Energy errors are relative to the energy's scale; "
             "errors of q and of p are Euclidean distances from the reference at the end. Bold: "
             "nothing else is both faster and better in {} error.</p>\n",
             to_text(bench.observed));
}

std::string ladder_table(const ReportContent& content) {
  const Bench& bench = *content.bench;
  std::vector<BenchAnswer> answers(bench.answers.begin() + 1, bench.answers.end());
  std::string rows;
  for (const BenchAnswer& answer : answers) {
    rows += "<tr>" + number_cell(target_number(answer.target));
    if (!answer.row) {
      rows += "<td colspan='3'>no method here</td></tr>\n";
      continue;
    }
    const BenchRow& row = bench.rows[*answer.row];
    rows += "<td class='name'>" + html_text(bench.methods[row.method].spec) + "</td>" +
            number_cell(html_number(to_double(row.h), 4)) +
            number_cell(html_seconds(time_of(row).seconds_per_time)) + "</tr>\n";
  }
  return fmt::format(
             "<div class='wide'><table><tr><th class='number'>{} error</th><th>quickest</th>"
             "<th class='number'>h</th><th class='number'>time</th></tr>\n",
             to_text(bench.observed)) +
         rows +
         "</table></div>\n<p class='note'>Measured; the time is for a unit of the model's "
         "time.</p>\n";
}

std::string html_seconds(double seconds) {
  if (seconds < 1e-6) return html_number(1e9 * seconds, 3) + " ns";
  if (seconds < 1e-3) return html_number(1e6 * seconds, 3) + " µs";
  if (seconds < 1.0) return html_number(1e3 * seconds, 3) + " ms";
  return html_number(seconds, 3) + " s";
}

}  // namespace hamgen::app
