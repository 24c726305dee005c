// The cost table: steps beside hand-written ones, GSL's and odeint's, and what checking and
// generating larger systems takes.
//
//   cost_benchmark [steps|commands [TEXT]]   the rows whose name holds TEXT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include "app/studies/bench_measure.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/setting.hpp"
#include "benchmarks/cost/command_cost.hpp"
#include "benchmarks/cost/cost_models.hpp"
#include "benchmarks/cost/step_rows.hpp"
#include "benchmarks/peers/peer.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "runtime/processor_time.hpp"

namespace hamgen::cost_table {
namespace {

constexpr int kRounds = 7;

// A step by hand that errs by no more has solved its equations.
constexpr double kSolved = 1e-15;

using Values = HandRow::Values;

// A step of hamgen's, one written by hand or a library's, and the best time seen.
struct Contender {
  std::string name;
  std::function<double()> seconds;  // of all steps
  std::string note = {};
  double best = std::numeric_limits<double>::infinity();
};

double timed(const std::function<void()>& work) {
  const double begin = runtime::thread_seconds();
  work();
  return runtime::thread_seconds() - begin;
}

SourceText source_of(const StepRow& row) {
  if (row.source.starts_with("system")) return make_source("model.ham", row.source);
  return read_source(std::string(HAMGEN_SOURCE_DIR "/hamiltonians/") + row.source);
}

SceneValues scene_of(const SourceText& source, const StepRow& row) {
  const Model model = read_request(source, row.request);
  SceneValues scene = app::complete_scene(model, {.scene = row.scene, .h = row.h});
  scene.steps = row.steps;
  return scene;
}

// A run of the integrator as `hamgen run` makes it, without its energy.
std::string add_hamgen(const StepRow& row, const SourceText& source, const SceneValues& scene,
                       std::vector<Contender>& list) {
  const auto method =
      std::make_shared<app::BenchMethod>(app::bench_method("", source, row.request, {}));
  if (!method->refusal.empty()) return method->refusal;
  const runtime::InitialValues start =
      app::initial_values(method->plugin, scene, *method->loaded.library);
  runtime::Integrator trial(method->loaded.library, start);
  const runtime::Report report = trial.advance(row.steps, false);
  const std::string outcome =
      report.status == runtime::Status::done
          ? fmt::format("{:.3g} iterations/step",
                        static_cast<double>(report.iterations) / static_cast<double>(row.steps))
          : fmt::format("ends in step {}", report.steps_done + 1);
  list.push_back({.name = row.request.plain_sums ? "hamgen --plain-sums" : "hamgen",
                  .seconds = [=] { return app::processor_clock(*method, start, row.steps); }});
  return method->plugin.solver + ", " + outcome;
}

Values start_values(const SceneValues& scene) {
  Values z;
  for (const auto* part : {&scene.q, &scene.p}) {
    for (const Rational& value : *part) z.push_back(value.get_d());
  }
  return z;
}

// With its tuned number of iterations and, where this leaves equations unsolved, with as many as
// solve them.
void add_hand(const StepRow& row, const SceneValues& scene, std::vector<Contender>& list) {
  const HandRow& hand = *row.hand;
  const Values start = start_values(scene);
  const double h = to_double(*scene.h);
  const auto add = [&](const std::string& name, int iterations, double lack) {
    list.push_back(
        {.name = name,
         .seconds = [=, &row] { return row.hand->seconds(start, h, iterations, row.steps); },
         .note =
             hand.lack ? fmt::format("{} iterations, solved to {:.1e}", iterations, lack) : ""});
  };
  if (!hand.lack) return add("hand-written", 0, 0.0);
  const long looked_at = std::min(row.steps, 2000L);
  const double tuned = hand.lack(start, h, hand.iterations, looked_at);
  add("hand-written", hand.iterations, tuned);
  if (tuned <= kSolved) return;
  for (int iterations = hand.iterations + 1; iterations < 20; ++iterations) {
    const double lack = hand.lack(start, h, iterations, looked_at);
    if (lack <= kSolved) return add("hand-written, solved", iterations, lack);
  }
}

std::vector<peers::Peer> peers_of(const StepRow& row, const SourceText& source,
                                  const SceneValues& scene) {
  const Model model = read_request(source, row.request);
  if (auto list = peers::peers_by_hand(model.name, scene.name, row.request.sizes)) return *list;
  // The gradient is the same by every method.
  const app::BenchMethod method = app::bench_method(
      "", source, {.scheme = "implicit-midpoint", .sizes = row.request.sizes}, {});
  const runtime::InitialValues start =
      app::initial_values(method.plugin, scene, *method.loaded.library);
  return peers::peers_of(std::make_shared<const peers::EmittedSystem>(
      method.loaded.library, app::rounded(start.parameters), start_values(scene)));
}

void add_peers(const StepRow& row, const SourceText& source, const SceneValues& scene,
               std::vector<Contender>& list) {
  const std::vector<peers::Peer> all = peers_of(row, source, scene);
  const double h = to_double(*scene.h);
  const Values z0 = start_values(scene);
  for (const std::string& name : row.peers) {
    const auto found = std::ranges::find(all, name, &peers::Peer::name);
    if (found == all.end()) continue;  // it does not take such a system
    const peers::Peer peer = *found;
    // rk2imp at twice the step takes the same trajectory, in steps of some thousand times.
    const bool doubled = name == "GSL rk2imp";
    const long steps = doubled ? std::max(1L, row.steps / (z0.size() > 20 ? 200 : 20)) : row.steps;
    const double step = doubled ? 2 * h : h;
    list.push_back({.name = name + (doubled ? " 2h" : ""),
                    .seconds =
                        [=] {
                          Values z = z0;
                          const double time = step * static_cast<double>(steps);
                          return timed([&] { (void)peer.integrate(z, time, step, {}); }) *
                                 static_cast<double>(row.steps) /
                                 static_cast<double>(doubled ? 2 * steps : steps);
                        },
                    .note = name == "odeint sb3a" ? "another method, of order 4" : ""});
  }
}

void measure(StepRow row) {
  const SourceText source = source_of(row);
  const SceneValues scene = scene_of(source, row);
  // `hamgen run` makes a step for its scene.
  row.request.scene = {.asked = {.scene = row.scene, .h = row.h}, .values = scene, .kept = {}};
  std::vector<Contender> list;
  const std::string solver = add_hamgen(row, source, scene, list);
  if (std::ranges::find(row.peers, "odeint velocity_verlet") != row.peers.end()) {
    StepRow plain = row;  // as odeint's are
    plain.request.plain_sums = true;
    add_hamgen(plain, source, scene, list);
  }
  if (row.hand) add_hand(row, scene, list);
  add_peers(row, source, scene, list);
  for (int round = 0; round < kRounds; ++round) {
    for (Contender& c : list) c.best = std::min(c.best, c.seconds());
  }
  fmt::print("{}: {}\n", row.name, solver);
  for (const Contender& c : list) {
    fmt::print("  {:<24}{:>12.1f} ns/step", c.name, 1e9 * c.best / static_cast<double>(row.steps));
    if (&c != &list.front()) fmt::print("   hamgen / this {:.2f}", list.front().best / c.best);
    fmt::print("{}{}\n", c.note.empty() ? "" : "   ", c.note);
  }
  std::fflush(stdout);
}

struct CommandRow {
  std::string name;
  std::vector<std::string> words;
};

std::vector<CommandRow> command_rows(const std::filesystem::path& directory) {
  const auto write = [&](const char* name, const char* text) {
    std::ofstream(directory / name) << text;
    return (directory / name).string();
  };
  const std::string fput = HAMGEN_SOURCE_DIR "/hamiltonians/fput.ham";
  const std::string bodies = write("bodies.ham", kBodies);
  const std::string mean_field = write("mean_field.ham", kMeanField);
  return {
      {"check mean field N = 200", {"check", mean_field}},
      {"generate mean field N = 200", {"generate", mean_field}},
      {"check FPUT N = 1e6", {"check", fput, "--set", "N=1000000"}},
      {"generate FPUT N = 1e5", {"generate", fput, "--set", "N=100000"}},
      {"generate FPUT N = 1e6", {"generate", fput, "--set", "N=1000000"}},
      {"generate 200 bodies", {"generate", bodies, "--set", "N=200"}},
      {"generate 200 bodies, Stormer-Verlet",
       {"generate", bodies, "--set", "N=200", "--scheme", "stormer-verlet"}},
  };
}

void measure(const CommandRow& row) {
  const CommandCost cost = run_command(HAMGEN_COMMAND_PATH, row.words, 120);
  fmt::print("{}: {}{:.2f} s, {} MB, {} bytes\n", row.name,
             cost.status == 0 ? "" : fmt::format("status {}, ", cost.status), cost.seconds,
             cost.megabytes, cost.output_bytes);
  std::fflush(stdout);
}

bool holds(const std::string& name, const std::string& text) {
  return name.find(text) != name.npos;
}

void measure_steps(const std::string& text) {
  for (const StepRow& row : step_rows()) {
    if (holds(row.name, text)) measure(row);
  }
}

void measure_commands(const std::string& text) {
  const std::filesystem::path directory =
      std::filesystem::temp_directory_path() / fmt::format("hamgen-cost-{}", getpid());
  std::filesystem::create_directory(directory);
  for (const CommandRow& row : command_rows(directory)) {
    if (holds(row.name, text)) measure(row);
  }
  std::filesystem::remove_all(directory);
}

int run(const std::vector<std::string>& words) {
  const std::string what = words.empty() ? "" : words.front();
  if (words.size() > 2 || (what != "" && what != "steps" && what != "commands")) {
    fmt::print(stderr, "usage: cost_benchmark [steps|commands [TEXT]]\n");
    return 2;
  }
  const std::string text = words.size() == 2 ? words.back() : "";
  if (what != "commands") measure_steps(text);
  if (what != "steps") measure_commands(text);
  return 0;
}

}  // namespace
}  // namespace hamgen::cost_table

int main(int count, char** words) {
  try {
    return hamgen::cost_table::run({words + 1, words + count});
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
