#include "benchmarks/cost/step_rows.hpp"

#include <algorithm>
#include <memory>

#include "benchmarks/cost/cost_models.hpp"
#include "benchmarks/cost/hand_steps.hpp"
#include "benchmarks/hand_problems.hpp"
#include "benchmarks/hand_written.hpp"
#include "runtime/processor_time.hpp"

namespace hamgen::cost_table {
namespace {

using namespace benchmarks;  // NOLINT(google-build-using-namespace): problems

using Values = HandRow::Values;

// On the heap: a thousand elements are many on the stack.
template <class Hand, class Problem, class Start>
std::unique_ptr<Hand> made(const Problem& problem, double h, const Start& start) {
  return std::make_unique<Hand>(problem, h, start);
}

// The compiler must not know that nobody looks at the result.
template <class Hand>
double kept(const std::unique_ptr<Hand>& hand, double seconds) {
  asm volatile("" ::"r"(hand.get()) : "memory");
  return seconds;
}

template <class Hand, class Problem>
HandRow implicit_of(const Problem& problem) {
  return {.iterations = Problem::iterations,
          .seconds =
              [problem](const Values& start, double h, int iterations, long steps) {
                const auto hand = made<Hand>(problem, h, start);
                const double begin = runtime::thread_seconds();
                // The tuned number is one that the compiler knows.
                if (iterations == Problem::iterations) {
                  hand->advance(steps);
                } else {
                  for (long s = 0; s < steps; ++s) hand->step(iterations);
                }
                return kept(hand, runtime::thread_seconds() - begin);
              },
          .lack =
              [problem](const Values& start, double h, int iterations, long steps) {
                return lack_of(*made<Hand>(problem, h, start), iterations, steps);
              }};
}

template <class Problem>
HandRow midpoint_of(const Problem& problem) {
  return implicit_of<HandMidpoint<Problem>>(problem);
}

template <class Problem>
HandRow midpoint_of_all(const Problem& problem) {
  return implicit_of<HandMidpointOfAll<Problem>>(problem);
}

// By Newton's iteration, with compensated sums: see benchmarks/hand_written.hpp.
template <class Problem>
HandRow newton_of(const Problem& problem) {
  return {.seconds = [problem](const Values& start, double h, int, long steps) {
    benchmarks::State<Problem> z;
    std::ranges::copy(start, z.begin());
    const auto hand = made<benchmarks::HandWritten<Problem>>(problem, h, z);
    const double begin = runtime::thread_seconds();
    hand->advance(steps);
    return kept(hand, runtime::thread_seconds() - begin);
  }};
}

template <class Problem>
HandRow verlet_of(const Problem& problem) {
  return {.seconds = [problem](const Values& start, double h, int, long steps) {
    const auto hand = made<HandVerlet<Problem>>(problem, h, start);
    const double begin = runtime::thread_seconds();
    hand->advance(steps);
    return kept(hand, runtime::thread_seconds() - begin);
  }};
}

Request sized(long n, const std::string& scheme = "", int order = 0) {
  return {.scheme = scheme, .order = order, .sizes = {{"N", n}}};
}

const std::string kMidpoint = "GSL rk2imp";
const std::string kOrder4 = "odeint sb3a";
const std::string kVerlet = "odeint velocity_verlet";

}  // namespace

std::vector<StepRow> step_rows() {
  const Request verlet = {.scheme = "stormer-verlet"};
  const std::vector<std::string> both = {kMidpoint, kOrder4};
  return {
      {"pendulum, midpoint",
       "pendulum.ham",
       "paper",
       {},
       400000,
       newton_of(benchmarks::Pendulum()),
       both},
      {"Henon-Heiles, midpoint",
       "henon_heiles.ham",
       "regular",
       {},
       400000,
       newton_of(benchmarks::HenonHeiles()),
       both},
      {"Kepler, midpoint", "kepler.ham", "e06", {}, 400000, newton_of(benchmarks::Kepler()), both},
      {"product, midpoint",
       "product.ham",
       "tao",
       {},
       400000,
       midpoint_of_all(HandProduct()),
       {kMidpoint}},
      {"double pendulum, midpoint",
       "double_pendulum.ham",
       "horizontal",
       {},
       100000,
       midpoint_of_all(HandDoublePendulum()),
       {kMidpoint}},
      {"outer solar system, midpoint, h = 10 d",
       "outer_solar_system.ham",
       "short_step",
       {},
       20000,
       midpoint_of(outer_planets()),
       both},
      {"50 bodies, midpoint", kBodies, "disk", {}, 500, midpoint_of(fifty_bodies()), both},
      {"chain of 24, midpoint", "fput.ham", "first_mode", sized(24), 20000,
       midpoint_of(HandFput<24>()), both, "1/20"},
      {"chain of 25, midpoint", "fput.ham", "first_mode", sized(25), 20000,
       midpoint_of(HandFput<25>()), both, "1/20"},
      {"stiff FPU m = 3, midpoint, h = 0.001",
       "stiff_fpu.ham",
       "w300",
       {},
       200000,
       midpoint_of(HandStiffFpu()),
       both},
      {"FPU N = 1000, midpoint", "fput.ham", "first_mode", sized(1000), 2000,
       midpoint_of(HandFput<1000>()), both, "1/20"},
      {"FPU N = 1000, midpoint, plucked", "fput.ham", "pluck", sized(1000), 2000,
       midpoint_of(HandFput<1000>()), both},
      {"FPU N = 1000, midpoint of order 4",
       "fput.ham",
       "pluck",
       sized(1000, "", 4),
       500,
       {},
       {kOrder4}},
      {"mean field N = 200, midpoint",
       kMeanField,
       "half",
       {},
       500,
       midpoint_of(HandMeanField<200>()),
       {kOrder4}},
      {"pendulum, Stormer-Verlet",
       "pendulum.ham",
       "paper",
       verlet,
       400000,
       verlet_of(HandPendulum()),
       {kVerlet}},
      {"Henon-Heiles, Stormer-Verlet",
       "henon_heiles.ham",
       "regular",
       verlet,
       400000,
       verlet_of(HandHenonHeiles()),
       {kVerlet}},
      {"Kepler, Stormer-Verlet",
       "kepler.ham",
       "e06",
       verlet,
       400000,
       verlet_of(HandKepler()),
       {kVerlet}},
      {"stiff FPU m = 3, Stormer-Verlet, h = 0.001",
       "stiff_fpu.ham",
       "w300",
       verlet,
       200000,
       verlet_of(HandStiffFpu()),
       {kVerlet}},
      {"outer solar system, Stormer-Verlet, h = 10 d",
       "outer_solar_system.ham",
       "short_step",
       verlet,
       20000,
       verlet_of(outer_planets()),
       {kVerlet}},
      {"FPU N = 1000, Stormer-Verlet",
       "fput.ham",
       "pluck",
       sized(1000, "stormer-verlet"),
       10000,
       verlet_of(HandFput<1000>()),
       {kVerlet}},
  };
}

}  // namespace hamgen::cost_table
