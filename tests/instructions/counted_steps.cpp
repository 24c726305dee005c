#include "tests/instructions/counted_steps.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "generator/pipeline.hpp"
#include "runtime/compile.hpp"
#include "runtime/process.hpp"
#include "runtime/temporary_directory.hpp"

namespace hamgen::instructions {
namespace {

namespace fs = std::filesystem;

// Both are whole periods of what steps do every 32nd time.
constexpr long kShortRun = 128;
constexpr long kLongRun = 640;

const char* const kProgram = R"(
#include <cstdio>
#include <cstring>
#include <valgrind/callgrind.h>

volatile double step_size;

template <class Propagator, class Parameters, class State, int n>
void count(const char* name, double h, const double (&start)[n], long steps) {
  static_assert(sizeof(State) == sizeof start);
  State z;
  std::memcpy(static_cast<void*>(&z), start, sizeof start);
  step_size = h;
  Propagator propagator(Parameters(), step_size, z);
  CALLGRIND_ZERO_STATS;
  const bool converged = propagator.advance(steps).converged;
  CALLGRIND_DUMP_STATS_AT(name);
  if (!converged) std::printf("%s: a step failed\n", name);
}

int main() {
)";

// Its system's, in a program of several.
std::string name_space(const std::string& step) {
  std::string name = step;
  std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0; });
  return name;
}

std::string checked_run(std::vector<std::string> command, const fs::path& directory) {
  const runtime::ProcessRequest request{.command = std::move(command),
                                        .working_directory = directory,
                                        .time_limit = std::chrono::minutes(20)};
  const runtime::ProcessResult result = runtime::run_process(request);
  if (result.succeeded()) return result.output;
  throw std::runtime_error(
      fmt::format("{}: {}\n{}", request.command.front(), end_text(result, request), result.output));
}

void compile(const std::vector<EmittedStep>& steps, const std::string& compiler,
             const fs::path& directory) {
  std::string text;
  std::string runs;
  for (const EmittedStep& step : steps) {
    text += step.header;
    for (const long length : {kShortRun, kLongRun}) {
      runs += fmt::format(
          "  count<{0}::method::Propagator, {0}::Parameters, {0}::State>(\"{1}.{2}\", {3}, "
          "{{{4}}}, "
          "{2});\n",
          name_space(step.name), step.name, length, step.h, fmt::join(step.state, ", "));
    }
  }
  std::ofstream(directory / "program.cpp") << text << kProgram << runs << "}\n";
  std::vector<std::string> command = {compiler, "program.cpp", "-o", "program"};
  // Nor with what some distributions add by default.
  const std::vector<std::string> plain = {"-march=x86-64", "-mtune=generic", "-fno-stack-protector",
                                          "-fcf-protection=none"};
  for (const std::string& flag : runtime::compile_flags({}, {}, {.extra_flags = plain})) {
    if (flag != "-shared") command.push_back(flag);
  }
  (void)checked_run(command, directory);
}

// What callgrind wrote when the program asked for it: "desc: Trigger: Client Request: NAME", then
// for each function lines "POSITION COUNT" of its own below "ob=OBJECT"; after "calls=" comes one
// of the function called.
struct Dump {
  std::string name;
  double instructions = 0;  // of the program itself
};
Dump read_dump(const fs::path& path) {
  Dump dump;
  std::ifstream file(path);
  bool own = false;
  bool called = false;
  const std::string trigger = "desc: Trigger: Client Request: ";
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(trigger)) dump.name = line.substr(trigger.size());
    if (line.starts_with("ob=")) own = line.ends_with("/program");
    const bool numbers =
        !line.empty() && std::string_view("0123456789+-*").find(line[0]) != std::string::npos;
    if (numbers && own && !called) dump.instructions += std::stod(line.substr(line.find(' ')));
    called = line.starts_with("calls=");
  }
  return dump;
}

}  // namespace

const std::vector<CountedStep>& main_steps() {
  static const std::vector<CountedStep> steps = {
      {"pendulum, implicit-midpoint", "pendulum", "paper"},
      {"henon_heiles, implicit-midpoint", "henon_heiles", "regular"},
      {"kepler, implicit-midpoint", "kepler", "e06"},
      {"double_pendulum, implicit-midpoint", "double_pendulum", "horizontal"},
      {"product, implicit-midpoint", "product", "tao"},
      {"outer_solar_system, implicit-midpoint", "outer_solar_system", "short_step"},
      {.name = "chain of 24, implicit-midpoint",
       .model = "fput",
       .scene = "first_mode",
       .sizes = {{"N", 24}}},
      {.name = "chain of 25, implicit-midpoint",
       .model = "fput",
       .scene = "first_mode",
       .sizes = {{"N", 25}}},
      {"stiff_fpu, implicit-midpoint", "stiff_fpu", "w50"},
      {"stiff_fpu w300, implicit-midpoint", "stiff_fpu", "w300"},
      {"pendulum, stormer-verlet", "pendulum", "paper", "stormer-verlet"},
      {"pendulum, implicit-midpoint, order 8", "pendulum", "paper", "", 8},
      {"kepler, gauss-8", "kepler", "e06", "gauss-8"},
  };
  return steps;
}

EmittedStep emitted_step(const CountedStep& step) {
  const SourceText source =
      read_source(fmt::format("{}/hamiltonians/{}.ham", HAMGEN_SOURCE_DIR, step.model));
  Request request;
  request.scheme = step.scheme;
  request.order = step.order;
  request.sizes = step.sizes;
  request.name_space = name_space(step.name) + "::method";
  const Model model = read_request(source, request);
  const SceneValues scene = scene_values(model, {.scene = step.scene});
  EmittedStep emitted{
      .name = step.name,
      .header = generate_plugin(source, request, HeaderText::without_proof).header.text};
  const std::string pragma = "#pragma once\n";
  emitted.header.erase(emitted.header.find(pragma), pragma.size());
  for (const auto* part : {&scene.q, &scene.p}) {
    for (const Rational& value : *part) emitted.state.push_back(value.get_d());
  }
  emitted.h = scene.h.value().get_d();
  return emitted;
}

EmittedStep slower(EmittedStep step, int instructions) {
  const std::string counter = "++steps_;\n";
  const auto at = step.header.find(counter);
  if (at == std::string::npos) throw std::runtime_error("no place for more instructions");
  std::string more = "volatile Real more = 0.0;\n";  // read, added to and written
  for (int i = 0; i < instructions; i += 3) more += "more = more + 1.0;\n";
  step.header.insert(at, more);
  return step;
}

Counts count_instructions(const std::vector<EmittedStep>& steps, const std::string& compiler) {
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  compile(steps, compiler, directory.path());
  const std::string said =
      checked_run({"valgrind", "--tool=callgrind", "-q", "--callgrind-out-file=counts",
                   "--compress-strings=no", "--compress-pos=no", "./program"},
                  directory.path());
  if (!said.empty()) throw std::runtime_error(said);
  Counts counts;
  for (const auto& entry : fs::directory_iterator(directory.path())) {
    if (!entry.path().filename().string().starts_with("counts.")) continue;
    const Dump dump = read_dump(entry.path());
    if (const auto dot = dump.name.rfind('.'); dot != std::string::npos) {
      const bool is_long = std::stol(dump.name.substr(dot + 1)) == kLongRun;
      counts[dump.name.substr(0, dot)] += is_long ? dump.instructions : -dump.instructions;
    }
  }
  for (auto& [name, count] : counts) count /= static_cast<double>(kLongRun - kShortRun);
  return counts;
}

}  // namespace hamgen::instructions
