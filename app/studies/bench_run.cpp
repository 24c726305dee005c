#include "app/studies/bench_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/bench_refine.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/scheme_spec.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "runtime/compiler.hpp"
#include "runtime/progress.hpp"

namespace hamgen::app {
namespace {

constexpr long kDefaultSteps = 2000;  // at the scene's h
constexpr long kMostSteps = 100'000'000;

Rational rational_value(const std::string& option, const std::string& text) {
  const std::string what = option + " " + text;
  return evaluate_constant(read_expression(what, text, {}), make_source(what, text), {});
}

double target_value(const std::string& text) {
  const double value = to_double(rational_value("--target", text));
  if (!(value > 0.0)) throw UsageError(fmt::format("--target {}: not a positive number", text));
  return value;
}

Observed observed_of(const std::string& text) {
  if (text == "energy") return Observed::energy;
  if (text == "state") return Observed::state;
  throw UsageError(fmt::format("--observe {}: there are energy and state", text));
}

struct Setting {
  SourceText source;
  Request base;  // sizes
  Model model;
  SceneValues scene;
  Rational time;
  std::vector<Rational> steps;  // sizes of
};

// h is changed a little where it does not divide the time, so that every row ends at the same time.
long step_count(const Rational& time, const Rational& h) {
  const Rational count = time / h;
  const double wanted = to_double(count);
  if (!(wanted > 0.0) || wanted > static_cast<double>(kMostSteps))
    throw UsageError(
        fmt::format("h = {:g} makes {:.3g} steps of the time {:g}\nhelp: between 1 and "
                    "1e8 can be measured; change --h or --time",
                    to_double(h), wanted, to_double(time)));
  return std::max(1L, static_cast<long>(std::ceil(wanted - 1e-9)));
}

Setting read_setting(const BenchRequest& options) {
  Setting setting;
  setting.source = read_model_source({.model = options.model});
  SizesAndRest set = split_sizes(read_model(setting.source), options.scene.set);
  setting.base.sizes = set.sizes;
  setting.model = read_model(setting.source, set.sizes);
  SceneRequest request = scene_request(options.scene, std::move(set.rest));
  request.h = options.scene_h;
  request.steps = options.scene_steps;
  // Given steps and time, the scene needs to have neither.
  if (!options.time.empty()) request.steps = "1";
  for (const std::string& h :
       options.h.empty() ? std::vector<std::string>{} : split_specs(options.h)) {
    request.h = h;
    setting.scene = complete_scene(setting.model, request, options.length);
    setting.steps.push_back(*setting.scene.h);
  }
  request.h = options.scene_h;
  if (setting.steps.empty()) {
    setting.scene = complete_scene(setting.model, request, options.length);
    for (int power = 3; power >= -4; --power) {
      const Rational factor = power >= 0 ? Rational(1L << power) : Rational(1, 1L << -power);
      setting.steps.push_back(*setting.scene.h * factor);
    }
  }
  if (!options.time.empty()) {
    setting.time = rational_value("--time", options.time);
    if (setting.time == 0) throw UsageError("--time 0: there is nothing to measure");
    if ((setting.time > 0) != (setting.steps.front() > 0))
      throw UsageError(fmt::format("--time {} and h = {:g} go in opposite directions", options.time,
                                   to_double(setting.steps.front())));
  } else {
    if (!options.h.empty()) {  // the scene's own time, whatever steps are compared
      SceneRequest own = request;
      setting.scene = complete_scene(setting.model, own, options.length);
    }
    setting.time = *setting.scene.h * std::min(*setting.scene.steps, kDefaultSteps);
  }
  return setting;
}

BenchRow row_of(std::size_t method, const Rational& time, const Rational& h) {
  BenchRow row{.method = method};
  row.steps = step_count(time, h);
  row.h = time / row.steps;
  return row;
}

// Counts steps; a bar for each kind of work.
class Work {
 public:
  Work(const std::string& label, long long steps, bool quiet)
      : bar_(label), steps_(steps), quiet_(quiet) {}
  void done(long long steps) {
    done_ += steps;
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    if (!quiet_) bar_.update({.steps_done = done_, .steps = steps_, .seconds = seconds});
  }

 private:
  runtime::ProgressBar bar_;
  long long steps_;
  bool quiet_;
  long long done_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

std::vector<BenchMethod> methods_of(const BenchRequest& options, const Setting& setting) {
  std::vector<std::string> specs =
      options.schemes.empty() ? default_specs(derive(setting.model)) : split_specs(options.schemes);
  std::vector<Request> requests;  // all of them first: a misspelt name compiles nothing
  for (const std::string& spec : specs) {
    requests.push_back(request_of_spec(spec, setting.base));
    take_gauge_at(setting.scene, setting.model, requests.back());
  }
  std::vector<BenchMethod> methods;
  for (std::size_t i = 0; i < specs.size(); ++i)
    methods.push_back(bench_method(specs[i], setting.source, requests[i], options.compiler));
  if (std::ranges::none_of(methods, [](const BenchMethod& m) { return m.refusal.empty(); }))
    throw UsageError(
        fmt::format("none of the schemes suits {}: {}", options.model, methods.front().refusal));
  return methods;
}

// For work of which a fraction is known.
std::function<void(double)> fraction_bar(runtime::ProgressBar& bar, bool quiet) {
  constexpr double parts = 1000.0;
  if (quiet) return [](double) {};
  return [&bar, begin = std::chrono::steady_clock::now()](double part) {
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    bar.update({.steps_done = static_cast<long long>(parts * part),
                .steps = static_cast<long long>(parts),
                .seconds = seconds,
                .show_rate = false});
  };
}

ReferenceSolution reference_with_bar(const BenchRequest& options, const Setting& setting) {
  runtime::ProgressBar bar("reference");
  ReferenceRequest request{.sizes = setting.base.sizes, .compiler = options.compiler};
  request.on_progress = fraction_bar(bar, options.quiet);
  return reference_solution(setting.source, setting.scene, setting.time, request);
}

void measure_all_errors(const BenchRequest& options, const Setting& setting, Bench& bench) {
  long long all = 0;
  for (const BenchRow& row : bench.rows) all += row.steps;
  Work work("errors", all, options.quiet);
  for (BenchRow& row : bench.rows) {
    if (interrupt_flag()) return;
    measure_errors(bench.methods[row.method], setting.scene, bench.reference, row);
    work.done(row.steps);
  }
}

// Round by round over all rows: what slows the machine for a while slows them alike.
void measure_all_times(const BenchRequest& options, const Setting& setting, Bench& bench) {
  long long all = 0;
  for (const BenchRow& row : bench.rows) all += row.ok() ? row.steps * row.runs_per_sample : 0;
  const long rounds = integer_value("--rounds " + options.rounds, options.rounds, 1);
  Work work("times", all * rounds, options.quiet);
  for (long round = 0; round < rounds; ++round) {
    for (BenchRow& row : bench.rows) {
      if (interrupt_flag()) return;
      if (!row.ok()) continue;
      measure_time(bench.methods[row.method], setting.scene, row);
      work.done(row.steps * row.runs_per_sample);
    }
  }
}

// No step is finer than a 64th of the finest that was asked for.
void add_steps_for_target(const BenchRequest& options, const Setting& setting, Bench& bench,
                          double target) {
  constexpr double furthest = 64;
  const double length = std::fabs(to_double(setting.time));
  double least = HUGE_VAL;
  for (const Rational& h : setting.steps) least = std::min(least, std::fabs(to_double(h)));
  runtime::ProgressBar bar("target");
  add_refined_rows(bench, {.target = target,
                           .time = setting.time,
                           .finest = std::max(least / furthest, length / kMostSteps),
                           .measure =
                               [&](BenchRow& row) {
                                 measure_errors(bench.methods[row.method], setting.scene,
                                                bench.reference, row);
                                 return !interrupt_flag();
                               },
                           .on_progress = fraction_bar(bar, options.quiet)});
}

}  // namespace

Bench run_bench(const BenchRequest& options) {
  const Observed observed = observed_of(options.observe);
  const double target = options.target.empty() ? 0.0 : target_value(options.target);
  const Setting setting = read_setting(options);
  Bench bench{.model = setting.model.name,
              .path = options.model,
              .scene = setting.scene.name,
              .time = to_double(setting.time),
              .observed = observed};
  bench.provenance = runtime::provenance_of(runtime::find_compiler(
      options.compiler.empty() ? std::nullopt : std::optional(options.compiler)));
  bench.methods = methods_of(options, setting);
  for (std::size_t m = 0; m < bench.methods.size(); ++m) {
    for (const Rational& h : setting.steps) bench.rows.push_back(row_of(m, setting.time, h));
  }
  bench.reference = reference_with_bar(options, setting);
  if (bench.reference.state.empty() && !interrupt_flag()) {
    print_error(
        fmt::format("hamgen: warning: no reference solution: {}; state errors are missing\n",
                    bench.reference.failure));
    bench.observed = Observed::energy;
  }
  measure_all_errors(options, setting, bench);
  if (target > 0.0) add_steps_for_target(options, setting, bench, target);
  measure_all_times(options, setting, bench);
  if (target > 0.0) {
    bench.answer =
        BenchAnswer{.target = target, .row = quickest_within(bench.rows, bench.observed, target)};
    if (bench.answer->row)
      bench.answer->command = generate_command(
          options.model, bench.methods[bench.rows[*bench.answer->row].method].request);
  }
  return bench;
}

}  // namespace hamgen::app
