// Models by chance in the hands of a compiler: the bits of the interpreter.
#include "tests/emitted/compiled.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "generator/interpreter/interpreter.hpp"
#include "generator/language/scene.hpp"
#include "tests/random/random_model.hpp"

namespace hamgen::random {
namespace {

constexpr int kSteps = 20;

struct Run {
  std::vector<double> parameters, state;
  double h = 0;
};

Run run_of(const Model& model, const Program& code) {
  const SceneValues scene = scene_values(model, {});
  Run run{.h = to_double(*scene.h)};
  for (const auto* values : {&scene.q, &scene.p}) {
    for (const Rational& value : *values) run.state.push_back(to_double(value));
  }
  const std::vector<std::string> names = element_names(model.parameters);
  for (const auto& [name, unit, comment, value] : code.environment.parameters) {
    const auto at = std::ranges::find(names, name) - names.begin();
    run.parameters.push_back(to_double(scene.parameters.at(static_cast<std::size_t>(at))));
  }
  return run;
}

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{:a} ", value);
  return text;
}
std::string list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{:a}, ", value);
  return text;
}

struct Unit {
  std::string headers, calls;
  std::vector<std::string> expected;  // a line a model
};

// What a model's header and the interpreter are to agree on: the state after some steps, how often
// was iterated, and both again from the first state on.
void add(Unit& unit, int seed, const std::optional<Request>& request) {
  RandomCase c = random_case(static_cast<std::uint64_t>(seed));
  if (request) c.request = *request;
  c.request.name_space = fmt::format("chance_{}", seed);
  const SourceText source = make_source("chance.ham", c.text);
  const Program code = make_program(source, c.request);
  const Run run = run_of(read_request(source, c.request), code);
  Interpreter<double> interpreted(code, run.parameters, run.h, run.state);
  std::string expected = std::to_string(seed);
  for (int part = 0; part < 2; ++part) {
    bool converged = true;
    long long iterations = 0;
    for (int i = 0; i < kSteps && converged; ++i) {
      const auto report = interpreted.step();
      converged = report.converged;
      iterations += report.iterations;
    }
    expected += fmt::format(" {} {} {}", converged, iterations, numbers(interpreted.state()));
    interpreted.reset(run.state, std::vector<double>(run.state.size()));
  }
  unit.expected.push_back(expected);
  unit.headers += emitted_test::without_pragma(
      generate_plugin(source, c.request, HeaderText::without_proof).header.text);
  unit.calls += fmt::format(
      "  run<{0}::Propagator, {0}::Parameters, {0}::State>({1}, {2:a}, {{{3}}}, {{{4}}});\n",
      c.request.name_space, seed, run.h, list(run.parameters), list(run.state));
}

// State and Parameters are their numbers, one after the other.
const std::string kRun = R"(
#include <cstdio>
#include <cstring>
#include <vector>
template <class Propagator, class Parameters, class State>
void run(int seed, double h, std::vector<double> parameters, std::vector<double> state) {
  Parameters par;
  State z, first;
  static_assert(std::is_trivially_copyable_v<State>);
  if (!parameters.empty()) std::memcpy(&par, parameters.data(), parameters.size() * sizeof(double));
  std::memcpy(&first, state.data(), sizeof z);
  Propagator propagator(par, h, first);
  std::printf("%d ", seed);
  for (int part = 0; part < 2; ++part) {
    const auto report = propagator.advance(20);
    z = propagator.state();
    std::memcpy(state.data(), &z, sizeof z);
    std::printf("%s %d ", report.converged ? "true" : "false", report.iterations);
    for (const double value : state) std::printf("%a ", value);
    propagator.reset(first);
  }
  std::printf("\n");
}
)";

// By the methods that the models are given, or by this one.
void expect_same_bits(int first, int count, const std::optional<Request>& request = {}) {
  Unit unit;
  for (int seed = first; seed < first + count; ++seed) add(unit, seed, request);
  std::istringstream output(
      emitted_test::run_program(unit.headers + kRun + "int main() {\n" + unit.calls + "}\n"));
  for (const std::string& expected : unit.expected) {
    std::string line;
    std::getline(output, line);
    // %a and {:a} may differ in how they write a number: the numbers count.
    std::istringstream found(line), wanted(expected);
    for (std::string a, b; wanted >> a;) {
      ASSERT_TRUE(found >> b) << line;
      if (a == b) continue;
      ASSERT_EQ(std::strtod(a.c_str(), nullptr), std::strtod(b.c_str(), nullptr))
          << expected << "\n"
          << line;
    }
  }
}

class RandomUnits : public testing::TestWithParam<int> {};

// A hundred models, 25 a unit; those from the second on by `ctest -C full`.
TEST_P(RandomUnits, AreCompiledToWhatIsInterpreted) { expect_same_bits(25 * GetParam(), 25); }

INSTANTIATE_TEST_SUITE_P(Of, RandomUnits, testing::Range(0, 4));

TEST(RandomSweeps, AreCompiledToWhatIsInterpreted) {
  expect_same_bits(100, 10, Request{.solver = "sweeps:3"});
}

}  // namespace
}  // namespace hamgen::random
