#include "app/output/bench_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "app/output/generate_command.hpp"
#include "app/output/json_document.hpp"
#include "app/output/plain_number.hpp"
#include "generator/base/quoted_text.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string error_cell(const std::optional<double>& error) {
  return error ? fmt::format("{:.2e}", *error) : "-";
}

using Cells = std::vector<std::string>;

// The lines of a table, column by column to the left (l) or to the right (r).
std::vector<std::string> aligned(const std::vector<Cells>& lines, std::string_view sides) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const Cells& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::vector<std::string> rows;
  for (const Cells& line : lines) {
    std::string row;
    for (std::size_t i = 0; i < line.size(); ++i)
      row += sides[i] == 'l' ? fmt::format("{:<{}}  ", line[i], widths[i])
                             : fmt::format("{:>{}}  ", line[i], widths[i]);
    rows.push_back("  " + row.substr(0, row.find_last_not_of(' ') + 1) + "\n");
  }
  return rows;
}

// By method, the largest step first: those that were found later too.
std::vector<std::size_t> in_order(const Bench& bench) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < bench.rows.size(); ++i) order.push_back(i);
  std::ranges::stable_sort(order, {}, [&bench](std::size_t i) {
    return std::pair(bench.rows[i].method, bench.rows[i].steps);
  });
  return order;
}

bool is_in(const std::vector<std::size_t>& front, std::size_t row) {
  return std::ranges::find(front, row) != front.end();
}

std::string remark(const Bench& bench, std::size_t row, const std::vector<std::size_t>& front) {
  const BenchRow& values = bench.rows[row];
  if (!values.ok()) return values.outcome;
  if (!values.unstable.empty()) return "unstable: " + values.unstable;
  if (bench.methods[values.method].is_baseline) return "";
  const bool is_answer = std::ranges::any_of(
      bench.answers, [row](const BenchAnswer& answer) { return answer.row == row; });
  const std::string mark = is_answer ? "<-" : is_in(front, row) ? "*" : "";
  return mark + (values.is_floor ? mark.empty() ? "floor" : " floor" : "");
}

std::string reference_text(const Bench& bench) {
  const ReferenceSolution& reference = bench.reference;
  if (reference.state.empty())
    return reference.failure.empty() ? "none is needed" : "none: " + reference.failure;
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

std::string run_line(const Bench& bench, const BenchRow& row) {
  return run_command(bench.path, bench.methods[row.method].request, row.h, row.steps);
}

// 1e-04 as 1e-4, where it is a power of ten.
std::string target_text(double target) {
  const double power = std::log10(target);
  return std::fabs(power - std::round(power)) < 1e-9
             ? fmt::format("1e{}", static_cast<int>(std::lround(power)))
             : fmt::format("{:g}", target);
}

// Where a baseline takes less time than the answer: does conservation pay at this length?
std::string baseline_text(const Bench& bench) {
  std::string text;
  for (const BenchAnswer& answer : bench.answers) {
    const auto cost = [](const BenchRow& row) { return time_of(row).seconds_per_time; };
    const BenchRow* best = answer.row ? &bench.rows[*answer.row] : nullptr;
    const BenchRow* quicker = nullptr;
    for (const BenchRow& row : bench.rows) {
      const std::optional<double> error = error_of(row, bench.observed);
      if (!bench.methods[row.method].is_baseline || row.samples.empty()) continue;
      if (!error || !(*error <= answer.target)) continue;
      if ((best == nullptr || cost(row) < cost(*best)) &&
          (quicker == nullptr || cost(row) < cost(*quicker)))
        quicker = &row;
    }
    if (quicker != nullptr)
      text +=
          fmt::format("  {} with h = {:.6g}, not symplectic, takes {:.2e} for {} at this length\n",
                      bench.methods[quicker->method].spec, to_double(quicker->h), cost(*quicker),
                      target_text(answer.target));
  }
  return text;
}

std::string answer_text(const Bench& bench) {
  if (bench.answers.empty()) return "";
  std::vector<Cells> lines = {{"error", "s/time", "scheme", "h"}};
  std::vector<std::string> commands = {""};
  for (const BenchAnswer& answer : bench.answers) {
    const std::string target = target_text(answer.target);
    if (!answer.row) {
      lines.push_back({target, "-", "no method reaches it with these steps", ""});
      commands.emplace_back();
      continue;
    }
    const BenchRow& row = bench.rows[*answer.row];
    lines.push_back({target, fmt::format("{:.2e}", time_of(row).seconds_per_time),
                     bench.methods[row.method].spec, fmt::format("{:.6g}", to_double(row.h))});
    commands.push_back(run_line(bench, row));
  }
  std::string text =
      fmt::format("time for {} {} error, in seconds for a unit of the model's time:\n",
                  bench.observed == Observed::energy ? "an" : "a", to_text(bench.observed));
  const std::vector<std::string> rows = aligned(lines, "lrll");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += rows[i];
    if (!commands[i].empty()) text += "      " + commands[i] + "\n";
  }
  return text + baseline_text(bench) + "\n";
}

OrderedJson answer_json(const Bench& bench, const BenchAnswer& answer) {
  OrderedJson result = {{"observe", to_text(bench.observed)}, {"error", answer.target}};
  if (!answer.row) {
    for (const char* key : {"row", "scheme", "h", "s_per_time", "run", "generate"})
      result[key] = nullptr;
    return result;
  }
  const BenchRow& row = bench.rows[*answer.row];
  const BenchMethod& method = bench.methods[row.method];
  result["row"] = *answer.row;
  result["scheme"] = method.spec;
  result["h"] = to_double(row.h);
  result["s_per_time"] = time_of(row).seconds_per_time;
  result["run"] = run_line(bench, row);
  result["generate"] = generate_command(bench.path, method.request);
  return result;
}

OrderedJson finite(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? OrderedJson(*value) : OrderedJson(nullptr);
}

bool is_symplectic(const BenchMethod& method) {
  const Scheme* scheme = method.request.scheme->scheme;
  return scheme == nullptr || scheme->symplectic;
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
          {"unstable", row.unstable.empty() ? OrderedJson(nullptr) : OrderedJson(row.unstable)},
          {"rounding_floor", row.is_floor},
          {"symplectic", is_symplectic(method)},
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

// Where not all rows are shown: the answers, the Pareto front, and what no row can be had of.
bool is_shown(const Bench& bench, std::size_t row, const std::vector<std::size_t>& front) {
  const BenchRow& values = bench.rows[row];
  if (!bench.methods[values.method].refusal.empty() || !values.unstable.empty()) return true;
  const bool is_answer = std::ranges::any_of(
      bench.answers, [row](const BenchAnswer& answer) { return answer.row == row; });
  return is_answer || is_in(front, row);
}

// The rows below the names of their methods.
std::string rows_text(const Bench& bench, const std::vector<std::size_t>& order,
                      const std::vector<std::size_t>& front) {
  std::vector<Cells> lines = {{"", "h", "s/time", "+-", "ns/step", "it/step", "grad/step",
                               "H error", "q error", "p error", ""}};
  for (const std::size_t i : order) {
    const BenchRow& row = bench.rows[i];
    const BenchTime time = time_of(row);
    const bool timed = !row.samples.empty();
    lines.push_back(
        {"", fmt::format("{:.6g}", to_double(row.h)),
         timed ? fmt::format("{:.2e}", time.seconds_per_time) : "-",
         timed ? fmt::format("{:.0f} %", 100.0 * time.spread) : "-",
         timed ? fmt::format("{:.0f}", time.nanoseconds_per_step) : "-",
         row.iterations_per_step > 0.0 ? fmt::format("{:.2f}", row.iterations_per_step) : "-",
         row.gradients_per_step > 0.0 ? terminal_number(row.gradients_per_step, 3) : "-",
         error_cell(row.relative_energy_error()), error_cell(row.q_error), error_cell(row.p_error),
         remark(bench, i, front)});
  }
  const std::vector<std::string> rows = aligned(lines, "lrrrrrrrrrl");
  std::string text = rows.front();
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t method = bench.rows[order[k]].method;
    if (k == 0 || method != bench.rows[order[k - 1]].method)
      text += fmt::format("  {}{}\n", bench.methods[method].spec,
                          bench.methods[method].is_baseline ? ", not symplectic" : "");
    text += rows[k + 1];
  }
  return text;
}

}  // namespace

std::string warning_text(const Bench& bench) {
  if (bench.reference.failure.empty()) return "";
  return fmt::format("hamgen: warning: no reference solution: {}; state errors are missing\n",
                     bench.reference.failure);
}

std::string table_text(const Bench& bench, bool all_rows) {
  const std::vector<std::size_t> front = pareto_front(bench.rows, bench.observed);
  std::string text = fmt::format("{}{}: T = {:.10g}\n", bench.model,
                                 bench.scene.empty() ? "" : ", scene " + bench.scene, bench.time);
  text += answer_text(bench);
  text +=
      fmt::format("  reference  {}\n  errors     {}\n", reference_text(bench), errors_text(bench));
  std::vector<std::size_t> order = in_order(bench);
  if (!all_rows)
    std::erase_if(order, [&](std::size_t row) { return !is_shown(bench, row, front); });
  if (!order.empty()) text += rows_text(bench, order, front);
  if (order.size() < bench.rows.size())
    text += fmt::format("{} of {} rows; --all shows all\n", order.size(), bench.rows.size());
  const auto any = [&](const auto& is_so) {
    return std::ranges::any_of(order, [&](std::size_t row) { return is_so(bench.rows[row]); });
  };
  if (!front.empty())
    text += fmt::format("* nothing here is both faster and better in {} error (Pareto front)\n",
                        to_text(bench.observed));
  if (any([](const BenchRow& row) { return row.is_floor; }))
    text += "floor: smaller steps are no better, for rounding\n";
  if (any([](const BenchRow& row) { return !row.unstable.empty(); }))
    text += "unstable: over ten times the time, or 5000 steps; no answer\n";
  if (bench.is_stopped) text += "stopped before all was measured\n";
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
    result["reference"] = {{"failure", reference.failure.empty() ? OrderedJson(nullptr)
                                                                 : OrderedJson(reference.failure)}};
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
  result["time_for_error"] = OrderedJson::array();
  for (const BenchAnswer& answer : bench.answers)
    result["time_for_error"].push_back(answer_json(bench, answer));
  result["stopped"] = bench.is_stopped;
  return json_document(result);
}

}  // namespace hamgen::app
