// Error against run time: hamgen's methods beside Boost.odeint's and GSL's on the same models.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>

#include "app/studies/bench_measure.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/scheme_spec.hpp"
#include "benchmarks/peers/peer.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "runtime/processor_time.hpp"

namespace hamgen::peers {
namespace {

struct Case {
  std::string path;
  std::string scene;
  std::string time;
  std::map<std::string, long> sizes = {};
};

constexpr int kRounds = 5;
constexpr std::array kTargets = {1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12};
// Fixed steps are 2^power times the scene's.
constexpr int kLargestPower = 6;
constexpr int kSmallestPower = -5;

// A method with one setting (a step size, or a tolerance).
struct Result {
  std::string method;
  bool is_peer = false;
  double setting = 0.0;
  double energy_error = 0.0;
  double state_error = 0.0;
  std::vector<double> seconds;  // of the whole time, one a round
  std::function<double()> sample;

  [[nodiscard]] double median() const { return quantile(seconds.size() / 2); }
  // Distance of the quartiles, relative to the median.
  [[nodiscard]] double spread() const {
    const std::size_t quarter = seconds.size() / 4;
    return (quantile(seconds.size() - 1 - quarter) - quantile(quarter)) / median();
  }
  [[nodiscard]] double quantile(std::size_t place) const {
    std::vector<double> sorted = seconds;
    std::ranges::sort(sorted);
    return sorted[place];
  }
};

double distance(const std::vector<double>& z, const std::vector<runtime::Wide>& reference) {
  double sum = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double difference = (z[i] - reference[i].hi) - reference[i].lo;
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

struct Problem {
  SourceText source;
  SceneValues scene;
  Rational time;
  std::map<std::string, long> sizes;
  Mechanics mechanics;
  app::ReferenceSolution reference;
};

Problem read_problem(const Case& chosen) {
  Problem problem;
  problem.source = read_source(chosen.path);
  problem.sizes = chosen.sizes;
  const Model model = read_model(problem.source, problem.sizes);
  problem.scene = app::complete_scene(model, {.scene = chosen.scene});
  problem.time = evaluate_constant(read_expression("time", chosen.time, {}),
                                   make_source("time", chosen.time), {});
  if (problem.time <= 0) throw UsageError("the time is not positive: " + chosen.time);
  problem.mechanics = derive(model);
  problem.reference = app::reference_solution(problem.source, problem.scene, problem.time,
                                              {.sizes = problem.sizes});
  if (problem.reference.state.empty())
    throw UsageError("no reference to measure errors against: " + problem.reference.failure);
  return problem;
}

bool is_explicit(const std::string& spec) {
  const Scheme* scheme = find_scheme(spec);
  return scheme != nullptr && std::holds_alternative<Splitting>(scheme->method);
}

// Returns the energy's scale, that of the last row.
double add_hamgen(const Problem& problem, std::vector<std::unique_ptr<app::BenchMethod>>& methods,
                  std::vector<Result>& results) {
  double scale = 0.0;
  std::vector<std::pair<std::string, bool>> specs;  // with plain sums?
  for (const std::string& spec : app::default_specs(problem.mechanics)) {
    specs.emplace_back(spec, false);
    // As those of the libraries are.
    if (is_explicit(spec)) specs.emplace_back(spec, true);
  }
  for (const auto& [of, plain_sums] : specs) {
    const Request request =
        app::request_of_spec(of, {.plain_sums = plain_sums, .sizes = problem.sizes});
    const std::string spec = of + (plain_sums ? " --plain-sums" : "");
    methods.push_back(
        std::make_unique<app::BenchMethod>(app::bench_method(spec, problem.source, request, {})));
    const app::BenchMethod& method = *methods.back();
    for (int power = kLargestPower; power >= kSmallestPower; --power) {
      app::BenchRow row;
      const Rational count = problem.time / *problem.scene.h *
                             (power < 0 ? Rational(1L << -power) : Rational(1, 1L << power));
      row.steps = std::max(1L, std::lround(count.get_d()));
      row.h = problem.time / row.steps;
      app::measure_errors(method, problem.scene, problem.reference, row);
      if (!row.ok()) continue;
      if (row.energy_scale > 0.0) scale = row.energy_scale;
      results.push_back({.method = spec,
                         .setting = row.h.get_d(),
                         .energy_error = row.energy_error.value_or(0.0),
                         .state_error = row.state_error.value_or(0.0),
                         .sample = [&method, &problem, row]() mutable {
                           row.samples.clear();
                           app::measure_time(method, problem.scene, row);
                           return row.samples.front();
                         }});
      // Smaller steps take longer, and reach no other target.
      const double reached =
          std::max(results.back().state_error, results.back().energy_error / row.energy_scale);
      if (reached <= kTargets.back()) break;
    }
  }
  return scale;
}

using Energy = std::function<double(const std::vector<double>&)>;

void add_peer(const Peer& peer, const Energy& energy_of, const std::vector<double>& start,
              const Problem& problem, std::vector<Result>& results) {
  const double time = problem.time.get_d();
  std::vector<double> settings;
  if (peer.adaptive) {
    for (double tolerance = 1e-3; tolerance > 0.5e-14; tolerance *= 0.1)
      settings.push_back(tolerance);
  } else {
    for (int power = kLargestPower; power >= kSmallestPower; --power)
      settings.push_back(problem.scene.h->get_d() * std::ldexp(1.0, power));
  }
  const double energy = energy_of(start);
  for (const double setting : settings) {
    Result result{.method = peer.name, .is_peer = true, .setting = setting};
    std::vector<double> z = start;
    const bool done = peer.integrate(z, time, setting, [&](const std::vector<double>& now) {
      result.energy_error = std::max(result.energy_error, std::fabs(energy_of(now) - energy));
    });
    result.state_error = distance(z, problem.reference.state);
    if (!done || !std::isfinite(result.state_error)) continue;
    const auto once = [peer, &start, time, setting] {
      std::vector<double> state = start;
      const double begin = runtime::thread_seconds();
      peer.integrate(state, time, setting, {});
      return runtime::thread_seconds() - begin;
    };
    const int runs = static_cast<int>(std::clamp(std::ceil(2e-3 / once()), 1.0, 1e4));
    result.sample = [once, runs] {
      double total = 0.0;
      for (int run = 0; run < runs; ++run) total += once();
      return total / runs;
    };
    results.push_back(std::move(result));
  }
}

std::optional<double> seconds_for(const std::vector<Result>& results, const std::string& method,
                                  double target, double Result::*error) {
  std::vector<const Result*> rows;  // by growing run time
  for (const Result& result : results) {
    if (result.method == method && result.*error > 0.0) rows.push_back(&result);
  }
  std::ranges::sort(rows, {}, [](const Result* row) { return row->median(); });
  const auto good =
      std::ranges::find_if(rows, [&](const Result* row) { return row->*error <= target; });
  if (good == rows.end()) return {};
  if (good == rows.begin()) return (*good)->median();
  const Result& fine = **good;
  const Result& coarse = **(good - 1);
  // Between two measured settings the error is a power of the time.
  const double part = std::log(coarse.*error / target) / std::log(coarse.*error / fine.*error);
  return coarse.median() * std::pow(fine.median() / coarse.median(), part);
}

void print_targets(const std::vector<Result>& results, const std::string& title, double time,
                   double Result::*error) {
  std::vector<std::pair<std::string, bool>> methods;  // in order; is it a peer?
  for (const Result& result : results) {
    if (methods.empty() || methods.back().first != result.method)
      methods.emplace_back(result.method, result.is_peer);
  }
  fmt::print("\n  {:<26}", title);
  for (const double target : kTargets) fmt::print(" {:>10.0e}", target);
  fmt::print("\n");
  std::map<std::pair<bool, double>, double> best;
  for (const auto& [method, is_peer] : methods) {
    fmt::print("  {:<26}", method);
    for (const double target : kTargets) {
      const auto seconds = seconds_for(results, method, target, error);
      fmt::print(" {:>10}", seconds ? fmt::format("{:.3g}", 1e6 * *seconds / time) : "-");
      if (!seconds) continue;
      const auto [at, added] = best.emplace(std::pair(is_peer, target), *seconds);
      if (!added) at->second = std::min(at->second, *seconds);
    }
    fmt::print("\n");
  }
  fmt::print("  {:<26}", "best peer / best hamgen");
  for (const double target : kTargets) {
    const auto peer = best.find({true, target});
    const auto own = best.find({false, target});
    fmt::print(" {:>10}", peer != best.end() && own != best.end()
                              ? fmt::format("{:.2f}", peer->second / own->second)
                          : own != best.end()  ? "no peer"
                          : peer != best.end() ? "no hamgen"
                                               : "-");
  }
  fmt::print("\n");
}

void compare(const Case& chosen, bool all_rows) {
  const Problem problem = read_problem(chosen);
  std::vector<std::unique_ptr<app::BenchMethod>> methods;
  std::vector<Result> results;
  const double scale = add_hamgen(problem, methods, results);
  const app::BenchMethod& first = *methods.front();
  const runtime::InitialValues values =
      app::initial_values(first.plugin, problem.scene, *first.loaded.library);
  const std::vector<double> parameters = app::rounded(values.parameters);
  const std::vector<double> start = app::rounded(values.state);
  const Energy energy = [&](const std::vector<double>& z) {
    return first.loaded.library->energy(parameters, z);
  };
  const std::string name = std::filesystem::path(chosen.path).stem().string();
  std::optional<std::vector<Peer>> peers = peers_by_hand(name, chosen.scene, chosen.sizes);
  const bool by_hand = peers.has_value();
  if (!by_hand) {
    peers =
        peers_of(std::make_shared<const EmittedSystem>(first.loaded.library, parameters, start));
  }
  for (const Peer& peer : *peers) add_peer(peer, energy, start, problem, results);
  if (scale > 0.0) {
    for (Result& result : results) result.energy_error /= scale;
  }
  for (int round = 0; round < kRounds; ++round) {
    for (Result& result : results) result.seconds.push_back(result.sample());
  }
  const double time = problem.time.get_d();
  std::string sizes;
  for (const auto& [name, size] : problem.sizes) sizes += fmt::format(", {} = {}", name, size);
  fmt::print(
      "\n{}, scene {}{}, T = {:g}; the reference's own error is {:.1e}, the energy's scale "
      "{:.3g}\n",
      chosen.path, problem.scene.name, sizes, time, problem.reference.error, scale);
  fmt::print("  the libraries have derivatives {}\n",
             by_hand ? "written by hand" : "by the gradient that hamgen emitted");
  std::vector<double> spreads;
  for (const Result& result : results) spreads.push_back(result.spread());
  std::ranges::sort(spreads);
  fmt::print(
      "  medians of {} rounds; their quartiles are {:.0f} % apart in half of the rows, {:.0f} % "
      "at most\n",
      kRounds, 100.0 * spreads[spreads.size() / 2], 100.0 * spreads.back());
  if (all_rows) {
    fmt::print("  {:<26} {:>9} {:>12} {:>13} {:>12}\n", "method", "h or tol", "us/unit time",
               "energy error", "state error");
    for (const Result& result : results)
      fmt::print("  {:<26} {:>9.3g} {:>12.4g} {:>13.2e} {:>12.2e}\n", result.method, result.setting,
                 1e6 * result.median() / time, result.energy_error, result.state_error);
  }
  print_targets(results, "us/unit, state error", time, &Result::state_error);
  print_targets(results, "us/unit, energy error", time, &Result::energy_error);
}

int run(const std::vector<std::string>& words) {
  const std::string models = HAMGEN_SOURCE_DIR "/hamiltonians/";
  std::vector<Case> cases = {{models + "pendulum.ham", "paper", "100"},
                             {models + "henon_heiles.ham", "regular", "100"},
                             {models + "kepler.ham", "e06", "20"},
                             {models + "double_pendulum.ham", "horizontal", "10"}};
  std::vector<std::string> rest = words;
  const bool all_rows = std::erase(rest, "--rows") > 0;
  std::map<std::string, long> sizes;
  for (; rest.size() > 3 && rest.back().find('=') != std::string::npos; rest.pop_back()) {
    const std::size_t sign = rest.back().find('=');
    sizes[rest.back().substr(0, sign)] = std::stol(rest.back().substr(sign + 1));
  }
  if (rest.size() == 3) {
    cases = {{rest[0], rest[1], rest[2], sizes}};
  } else if (!rest.empty()) {
    fmt::print(stderr, "usage: peers_benchmark [--rows] [MODEL.ham SCENE TIME [SIZE=NUMBER...]]\n");
    return 2;
  }
  for (const Case& chosen : cases) compare(chosen, all_rows);
  return 0;
}

}  // namespace
}  // namespace hamgen::peers

int main(int argc, char** argv) {
  try {
    return hamgen::peers::run(std::vector<std::string>(argv + 1, argv + argc));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
