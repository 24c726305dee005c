#include "app/output/bench_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/output/generate_command.hpp"
#include "app/output/json_document.hpp"
#include "generator/base/quoted_text.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string error_cell(const std::optional<double>& error) {
  return error ? fmt::format("{:.2e}", *error) : "-";
}

using Cells = std::vector<std::string>;

// The first column to the left, the others to the right.
std::string aligned(const std::vector<Cells>& lines) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const Cells& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (const Cells& line : lines) {
    std::string row;
    for (std::size_t i = 0; i < line.size(); ++i)
      row += i == 0 || i + 1 == line.size() ? fmt::format("{:<{}}  ", line[i], widths[i])
                                            : fmt::format("{:>{}}  ", line[i], widths[i]);
    text += "  " + row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

bool is_in(const std::vector<std::size_t>& front, std::size_t row) {
  return std::ranges::find(front, row) != front.end();
}

std::string remark(const Bench& bench, std::size_t row, const std::vector<std::size_t>& front) {
  const BenchRow& values = bench.rows[row];
  if (!values.ok()) return values.outcome;
  const bool is_answer = std::ranges::any_of(
      bench.answers, [row](const BenchAnswer& answer) { return answer.row == row; });
  return is_answer ? "<- target" : is_in(front, row) ? "*" : "";
}

std::string reference_text(const Bench& bench) {
  const ReferenceSolution& reference = bench.reference;
  if (reference.state.empty()) return "none: " + reference.failure;
  return fmt::format(
      "extrapolated in quad precision, its own error {:.1e}{}", reference.error,
      reference.from_cache ? ", computed before" : fmt::format(", {:.2g} s", reference.seconds));
}

// What the energy errors are relative to; 0 where no row has one.
double energy_scale(const Bench& bench) {
  double scale = 0.0;
  for (const BenchRow& row : bench.rows) scale = std::max(scale, row.energy_scale);
  return scale;
}

// What the columns of errors are.
std::string errors_text(const Bench& bench) {
  return fmt::format(
      "of the energy relative to its scale {:.3g}; of q and of p at the end, Euclidean",
      energy_scale(bench));
}

// That emits the quickest method; empty if none is good enough.
std::string answer_command(const Bench& bench, const BenchAnswer& answer) {
  if (!answer.row) return "";
  return generate_command(bench.path, bench.methods[bench.rows[*answer.row].method].request);
}

std::string answer_text(const Bench& bench, const BenchAnswer& answer) {
  if (!answer.row)
    return fmt::format(
        "no method reaches the {} error {:g} with these steps\n"
        "help: give smaller ones with --h, or methods of higher order with --schemes\n",
        to_text(bench.observed), answer.target);
  const BenchRow& row = bench.rows[*answer.row];
  return fmt::format(
      "{} error {:g} is reached soonest by {} with h = {:.10g}: {:.3g} s for a unit "
      "of time\n  {}\n",
      to_text(bench.observed), answer.target, bench.methods[row.method].spec, to_double(row.h),
      time_of(row).seconds_per_time, answer_command(bench, answer));
}

OrderedJson answer_json(const Bench& bench, const BenchAnswer& answer) {
  return {{"observe", to_text(bench.observed)},
          {"target", answer.target},
          {"row", answer.row ? OrderedJson(*answer.row) : OrderedJson(nullptr)},
          {"command", answer_command(bench, answer)}};
}

OrderedJson finite(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? OrderedJson(*value) : OrderedJson(nullptr);
}

OrderedJson row_json(const Bench& bench, const BenchRow& row) {
  const BenchTime time = time_of(row);
  const bool timed = !row.samples.empty();
  const auto if_timed = [timed](double value) {
    return timed ? OrderedJson(value) : OrderedJson(nullptr);
  };
  OrderedJson invariants = OrderedJson::object();
  const BenchMethod& method = bench.methods[row.method];
  for (std::size_t i = 0; i < row.invariant_errors.size(); ++i)
    invariants[method.plugin.invariant_names[i]] = finite(row.invariant_errors[i]);
  return {{"scheme", method.spec},
          {"h", to_double(row.h)},
          {"steps", row.steps},
          {"outcome", row.outcome},
          {"s_per_time", if_timed(time.seconds_per_time)},
          {"time_spread", if_timed(time.spread)},
          {"ns_per_step", if_timed(time.nanoseconds_per_step)},
          {"iterations_per_step", row.iterations_per_step},
          {"gradients_per_step", row.gradients_per_step},
          {"max_energy_error", finite(row.energy_error)},
          {"max_relative_energy_error", finite(row.relative_energy_error())},
          {"energy_spread", finite(row.energy_spread)},
          {"state_error", finite(row.state_error)},
          {"q_error", finite(row.q_error)},
          {"p_error", finite(row.p_error)},
          {"invariant_errors", invariants}};
}

std::string csv_number(const std::optional<double>& value) {
  return value ? runtime::number_text(*value) : "";
}

}  // namespace

std::string warning_text(const Bench& bench) {
  if (!bench.reference.state.empty()) return "";
  return fmt::format("hamgen: warning: no reference solution: {}; state errors are missing\n",
                     bench.reference.failure);
}

std::string table_text(const Bench& bench) {
  const std::vector<std::size_t> front = pareto_front(bench.rows, bench.observed);
  std::string text = fmt::format("{}{}: T = {:.10g}\n  reference  {}\n  errors     {}\n",
                                 bench.model, bench.scene.empty() ? "" : ", scene " + bench.scene,
                                 bench.time, reference_text(bench), errors_text(bench));
  std::vector<Cells> lines = {{"scheme", "h", "s/time", "+-", "ns/step", "it/step", "grad/step",
                               "energy error", "q error", "p error", ""}};
  for (std::size_t i = 0; i < bench.rows.size(); ++i) {
    const BenchRow& row = bench.rows[i];
    const BenchTime time = time_of(row);
    const bool timed = !row.samples.empty();
    lines.push_back(
        {bench.methods[row.method].spec, fmt::format("{:.6g}", to_double(row.h)),
         timed ? fmt::format("{:.2e}", time.seconds_per_time) : "-",
         timed ? fmt::format("{:.0f} %", 100.0 * time.spread) : "-",
         timed ? fmt::format("{:.0f}", time.nanoseconds_per_step) : "-",
         row.iterations_per_step > 0.0 ? fmt::format("{:.2f}", row.iterations_per_step) : "-",
         row.gradients_per_step > 0.0 ? fmt::format("{:.3g}", row.gradients_per_step) : "-",
         error_cell(row.relative_energy_error()), error_cell(row.q_error), error_cell(row.p_error),
         remark(bench, i, front)});
  }
  text += aligned(lines);
  if (!front.empty())
    text += fmt::format("* nothing here is both faster and better in {} error (Pareto front)\n",
                        to_text(bench.observed));
  for (const BenchAnswer& answer : bench.answers) text += answer_text(bench, answer);
  return text;
}

std::string csv_text(const Bench& bench) {
  std::string text = fmt::format(
      "# made by   hamgen {}\n# model     {}\n# time      {}\n# reference {}\n"
      "# energy    errors are absolute, and relative to the scale {}\n"
      "# machine   {}\n# compiler  {}\n# flags     {}\n# date      {}\n"
      "scheme,h,steps,outcome,s_per_time,time_spread,ns_per_step,iterations_per_step,"
      "gradients_per_step,"
      "max_energy_error,max_relative_energy_error,energy_spread,state_error,q_error,p_error",
      HAMGEN_VERSION, comment_text(bench.path), runtime::number_text(bench.time),
      comment_text(reference_text(bench)), runtime::number_text(energy_scale(bench)),
      comment_text(bench.provenance.machine), comment_text(bench.provenance.compiler),
      comment_text(bench.provenance.flags), bench.provenance.date);
  std::vector<std::string> names;
  for (const BenchMethod& method : bench.methods) {
    if (method.refusal.empty()) names = method.plugin.invariant_names;
  }
  for (const std::string& name : names) text += ",error_" + name;
  text += "\n";
  for (const BenchRow& row : bench.rows) {
    const BenchTime time = time_of(row);
    const bool timed = !row.samples.empty();
    const auto if_timed = [timed](double value) {
      return timed ? runtime::number_text(value) : std::string();
    };
    text +=
        fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
                    runtime::csv_cell(visible_text(bench.methods[row.method].spec)),
                    runtime::number_text(to_double(row.h)), row.steps,
                    runtime::csv_cell(visible_text(row.outcome)), if_timed(time.seconds_per_time),
                    if_timed(time.spread), if_timed(time.nanoseconds_per_step),
                    runtime::number_text(row.iterations_per_step),
                    runtime::number_text(row.gradients_per_step), csv_number(row.energy_error),
                    csv_number(row.relative_energy_error()), csv_number(row.energy_spread),
                    csv_number(row.state_error), csv_number(row.q_error), csv_number(row.p_error));
    for (std::size_t i = 0; i < names.size(); ++i)
      text += row.ok() ? "," + runtime::number_text(row.invariant_errors[i]) : ",";
    text += "\n";
  }
  return text;
}

std::string json_text(const Bench& bench) {
  OrderedJson result = {
      {"model", bench.model},
      {"path", bench.path},
      {"scene", bench.scene.empty() ? OrderedJson(nullptr) : OrderedJson(bench.scene)},
      {"time", bench.time},
      {"energy_scale", energy_scale(bench)},
      {"machine", bench.provenance.machine},
      {"compiler", bench.provenance.compiler},
      {"flags", bench.provenance.flags},
      {"date", bench.provenance.date}};
  const ReferenceSolution& reference = bench.reference;
  if (reference.state.empty()) {
    result["reference"] = {{"failure", reference.failure}};
  } else {
    OrderedJson state = OrderedJson::array();
    for (const auto& value : reference.state) state.push_back({value.hi, value.lo});
    result["reference"] = {{"error", reference.error},
                           {"state", state},
                           {"from_cache", reference.from_cache},
                           {"seconds", reference.seconds}};
  }
  result["rows"] = OrderedJson::array();
  for (const BenchRow& row : bench.rows) result["rows"].push_back(row_json(bench, row));
  for (const Observed observed : {Observed::energy, Observed::state})
    result["pareto"][std::string(to_text(observed))] = pareto_front(bench.rows, observed);
  for (const BenchAnswer& answer : bench.answers) {
    if (bench.answers.size() == 1)
      result["answer"] = answer_json(bench, answer);
    else
      result["answers"].push_back(answer_json(bench, answer));
  }
  return json_document(result);
}

}  // namespace hamgen::app
