// The cost table: steps of larger systems beside hand-written ones and GSL's, and what checking and
// generating them takes.
//
//   cost_benchmark [TEXT]   the rows whose name holds TEXT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>

#include "app/studies/bench_measure.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/setting.hpp"
#include "benchmarks/cost/command_cost.hpp"
#include "benchmarks/cost/cost_models.hpp"
#include "benchmarks/cost/hand_steps.hpp"
#include "benchmarks/peers/peer.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "runtime/processor_time.hpp"

namespace hamgen::cost_table {
namespace {

constexpr int kRounds = 7;

using Values = std::vector<double>;
// Takes so many steps from the start.
using Steps = std::function<void(long)>;
using HandSteps = std::function<Steps(const Values& start, double h)>;

struct StepRow {
  std::string name;
  std::string source;  // a shipped model's file, or the text of one
  std::string scene;
  Request request;
  long steps;
  HandSteps hand;                     // may be empty
  bool by_gsl = false;                // rk2imp at twice the step takes the same trajectory
  std::optional<std::string> h = {};  // else the scene's
};

// A hand-written step or a library's, and the best time seen.
struct Contender {
  std::string name;
  std::function<double()> seconds;  // of all steps
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
                       const std::string& solver, std::vector<Contender>& list) {
  Request request = row.request;
  request.solver = solver;
  const auto method =
      std::make_shared<app::BenchMethod>(app::bench_method("", source, request, {}));
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
  list.push_back({.name = "hamgen" + (solver.empty() ? "" : " " + solver),
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

void add_gsl(const StepRow& row, const SourceText& source, const SceneValues& scene,
             std::vector<Contender>& list) {
  const app::BenchMethod method = app::bench_method("", source, row.request, {});
  if (!method.refusal.empty()) return;
  const runtime::InitialValues start =
      app::initial_values(method.plugin, scene, *method.loaded.library);
  Values parameters;
  for (const runtime::Wide& value : start.parameters) parameters.push_back(value.hi);
  const auto flow = std::make_shared<peers::Flow>(method.loaded.library, parameters);
  const std::vector<peers::Peer> peers = peers::gsl_peers();
  const auto midpoint = std::ranges::find(peers, "GSL rk2imp", &peers::Peer::name);
  const double h = scene.h->get_d();
  const long steps = std::max(1L, row.steps / 20);
  const peers::Peer peer = *midpoint;
  list.push_back({.name = "GSL rk2imp 2h", .seconds = [=, z0 = start_values(scene)] {
                    Values z = z0;
                    const double time = 2 * h * static_cast<double>(steps);
                    return timed([&] { (void)peer.integrate(*flow, z, time, 2 * h, {}); }) *
                           static_cast<double>(row.steps) / (2.0 * static_cast<double>(steps));
                  }});
}

void measure(StepRow row) {
  const SourceText source = source_of(row);
  const SceneValues scene = scene_of(source, row);
  // `hamgen run` makes a step for its scene.
  row.request.scene = {.asked = {.scene = row.scene, .h = row.h}, .values = scene, .kept = {}};
  std::vector<Contender> list;
  const std::string solver = add_hamgen(row, source, scene, row.request.solver.text(), list);
  if (row.hand) {
    list.push_back({.name = "hand-written", .seconds = [&] {
                      const Steps steps = row.hand(start_values(scene), to_double(*scene.h));
                      return timed([&] { steps(row.steps); });
                    }});
  }
  if (row.by_gsl) add_gsl(row, source, scene, list);
  for (int round = 0; round < kRounds; ++round) {
    for (Contender& c : list) c.best = std::min(c.best, c.seconds());
  }
  fmt::print("{}: {}\n", row.name, solver);
  for (const Contender& c : list) {
    fmt::print("  {:<24}{:>12.1f} ns/step", c.name, 1e9 * c.best / static_cast<double>(row.steps));
    if (&c != &list.front()) fmt::print("   hamgen / this {:.2f}", list.front().best / c.best);
    fmt::print("\n");
  }
  std::fflush(stdout);
}

template <class Hand>
Steps steps_by(std::shared_ptr<Hand> hand) {
  return [hand](long steps) { hand->advance(steps); };
}

template <class Problem>
HandSteps midpoint_of(const Problem& problem) {
  return [problem](const Values& z, double h) {
    return steps_by(std::make_shared<HandMidpoint<Problem>>(problem, h, z));
  };
}

HandSteps verlet_of_chain() {
  return [](const Values& z, double h) {
    return steps_by(std::make_shared<HandVerlet<1000>>(0.25, h, z));
  };
}

Request sized(long n, const std::string& scheme = "", int order = 0) {
  return {.scheme = scheme, .order = order, .sizes = {{"N", n}}};
}

std::vector<StepRow> step_rows() {
  HandBodies<6, 5, 1> planets;
  planets.mass = {1.00000597682,      0.000954786104043,  0.000285583733151,
                  0.0000437273164546, 0.0000517759138449, 1 / 1.3e8};
  planets.strength = 2.95912208286e-4;
  HandBodies<50, 5, 1> bodies;
  bodies.mass.fill(1.0);
  bodies.strength = 1.0 / 50;
  bodies.softening = 0.01;
  return {
      {"pendulum, midpoint", "pendulum.ham", "paper", {}, 400000, {}, true},
      {"Henon-Heiles, midpoint", "henon_heiles.ham", "regular", {}, 400000, {}, true},
      {"Kepler, midpoint", "kepler.ham", "", {}, 400000, {}, true},
      {"outer solar system, midpoint, h = 10 d",
       "outer_solar_system.ham",
       "short_step",
       {},
       20000,
       midpoint_of(planets),
       true},
      {"50 bodies, midpoint", kBodies, "disk", {}, 500, midpoint_of(bodies)},
      {"chain of 24, midpoint", "fput.ham", "first_mode", sized(24), 20000,
       midpoint_of(HandFput<24>()), false, "1/20"},
      {"chain of 25, midpoint", "fput.ham", "first_mode", sized(25), 20000,
       midpoint_of(HandFput<25>()), false, "1/20"},
      {"stiff FPU m = 3, midpoint, h = 0.001",
       "stiff_fpu.ham",
       "w300",
       {},
       200000,
       midpoint_of(HandStiffFpu()),
       true},
      {"FPU N = 1000, midpoint", "fput.ham", "first_mode", sized(1000), 2000,
       midpoint_of(HandFput<1000>()), false, "1/20"},
      {"FPU N = 1000, midpoint, plucked", "fput.ham", "pluck", sized(1000), 2000,
       midpoint_of(HandFput<1000>())},
      {"FPU N = 1000, Stormer-Verlet", "fput.ham", "pluck", sized(1000, "stormer-verlet"), 10000,
       verlet_of_chain()},
      {"FPU N = 1000, midpoint of order 4", "fput.ham", "pluck", sized(1000, "", 4), 500, {}},
      {"mean field N = 200, midpoint", kMeanField, "half", {}, 500, {}},
  };
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

void measure_all(const std::string& text) {
  const auto wanted = [&](const std::string& name) { return name.find(text) != name.npos; };
  for (const StepRow& row : step_rows()) {
    if (wanted(row.name)) measure(row);
  }
  const std::filesystem::path directory =
      std::filesystem::temp_directory_path() / fmt::format("hamgen-cost-{}", getpid());
  std::filesystem::create_directory(directory);
  for (const CommandRow& row : command_rows(directory)) {
    if (wanted(row.name)) measure(row);
  }
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace hamgen::cost_table

int main(int count, char** words) {
  try {
    hamgen::cost_table::measure_all(count > 1 ? words[1] : "");
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
