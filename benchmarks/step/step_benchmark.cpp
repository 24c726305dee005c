// Time per step of the emitted midpoint rule, against GSL, Boost.odeint and hand-written code.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <gsl/gsl_errno.h>

#include <iostream>
#include <string>
#include <vector>

#include "benchmarks/accuracy.hpp"
#include "benchmarks/emitted.hpp"
#include "benchmarks/gsl_midpoint.hpp"
#include "benchmarks/hand_written.hpp"
#include "benchmarks/problems.hpp"
#include "benchmarks/summary.hpp"

#if __has_include(<boost/numeric/odeint.hpp>)
#include "benchmarks/odeint_splitting.hpp"
#define HAMGEN_BENCHMARK_ODEINT 1
#else
#define HAMGEN_BENCHMARK_ODEINT 0
#endif

namespace hamgen::benchmarks {
namespace {

// About eight periods of the pendulum, 160 of Henon-Heiles: the number of Newton iterations
// depends on where the orbit is.
constexpr long long steps_per_iteration = 10000;
constexpr long long accuracy_steps = 100000;

// The same stretch of the orbit in every iteration.  The compiler must not know h, the parameters
// and the initial values: a plugin's compiler does not either.
template <class Method, class Problem>
void measure(benchmark::State& state) {
  for (auto _ : state) {
    Problem problem;
    double h = Problem::h;
    State<Problem> z = Problem::start;
    // Their addresses, not they: with GCC DoNotOptimize of Google Benchmark 1.7 damages a value.
    benchmark::DoNotOptimize(&problem);
    benchmark::DoNotOptimize(&h);
    benchmark::DoNotOptimize(&z);
    Method method(problem, h, z);
    if (!method.advance(steps_per_iteration)) {
      state.SkipWithError("a step did not converge");
      break;
    }
    z = method.state();
    benchmark::DoNotOptimize(&z);
  }
  state.counters["per_step"] = benchmark::Counter(
      static_cast<double>(steps_per_iteration),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Method, class Problem>
void add(std::vector<Row>& rows, int stride = 1) {
  const Row row = {.problem = Problem::name,
                   .method = Method::name,
                   .steps_per_iteration = static_cast<double>(steps_per_iteration),
                   .accuracy = accuracy_of<Method>(Problem(), stride, accuracy_steps)};
  benchmark::RegisterBenchmark(row.benchmark_name().c_str(), measure<Method, Problem>)
      ->Unit(benchmark::kMicrosecond);
  rows.push_back(row);
}

template <class Problem>
void add_methods(std::vector<Row>& rows) {
  add<Emitted<Problem>, Problem>(rows);
  add<HandWritten<Problem>, Problem>(rows);
  add<GslMidpoint<Problem, 1>, Problem>(rows);
  add<GslMidpoint<Problem, 2>, Problem>(rows, 2);
#if HAMGEN_BENCHMARK_ODEINT
  add<OdeintSplitting<Problem>, Problem>(rows);
#endif
}

// Nine interleaved repetitions unless the command line says otherwise: what else the machine does
// then falls on all methods alike.
std::vector<std::string> arguments(int argc, char** argv) {
  std::vector<std::string> words = {argv[0], "--benchmark_repetitions=9",
                                    "--benchmark_min_time=0.1",
                                    "--benchmark_enable_random_interleaving=true"};
  words.insert(words.end(), argv + 1, argv + argc);
  return words;
}

int run(int argc, char** argv) {
  std::vector<std::string> words = arguments(argc, argv);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  int count = static_cast<int>(pointers.size());
  pointers.push_back(nullptr);
  benchmark::Initialize(&count, pointers.data());
  if (benchmark::ReportUnrecognizedArguments(count, pointers.data())) return 2;

  gsl_set_error_handler_off();
  std::vector<Row> rows;
  add_methods<Pendulum>(rows);
  add_methods<HenonHeiles>(rows);
  benchmark::AddCustomContext("compiler", fmt::format("{}", __VERSION__));
  benchmark::AddCustomContext("flags", HAMGEN_BENCHMARK_FLAGS);
  Repetitions times;
  benchmark::RunSpecifiedBenchmarks(&times);
  print_summary(std::cout, rows, times, accuracy_steps);
  benchmark::Shutdown();
  return 0;
}

}  // namespace
}  // namespace hamgen::benchmarks

int main(int argc, char** argv) { return hamgen::benchmarks::run(argc, argv); }
