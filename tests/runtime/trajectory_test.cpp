#include "runtime/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "runtime/load_plugin.hpp"
#include "runtime/progress.hpp"
#include "tests/runtime/oscillator.hpp"

namespace hamgen::runtime {
namespace {

using tests::oscillator;
using tests::oscillator_library;
using tests::oscillator_run;

std::vector<long long> recorded_steps(long long steps, long long every, long long fail_after = 0) {
  Integrator run = oscillator_run(fail_after);
  std::vector<long long> list;
  (void)integrate(run, {.steps = steps, .every = every, .on_record = [&list](const Record& record) {
                          list.push_back(record.step);
                        }});
  return list;
}

TEST(Integrate, RecordsTheStartAndEveryKthStep) {
  EXPECT_EQ(recorded_steps(10, 5), (std::vector<long long>{0, 5, 10}));
  EXPECT_EQ(recorded_steps(11, 5), (std::vector<long long>{0, 5, 10}));
  EXPECT_EQ(recorded_steps(3, 1), (std::vector<long long>{0, 1, 2, 3}));
  EXPECT_EQ(recorded_steps(3, 100), (std::vector<long long>{0}));
  EXPECT_EQ(recorded_steps(0, 1), (std::vector<long long>{0}));
  EXPECT_EQ(recorded_steps(3, 0), (std::vector<long long>{}));
  EXPECT_EQ(recorded_steps(100, 2, 5), (std::vector<long long>{0, 2, 4}));
}

TEST(Integrate, HandsOutTimeStateEnergyAndInvariants) {
  Integrator run = oscillator_run();
  (void)integrate(run, {.steps = 8, .every = 1, .on_record = [&run](const Record& record) {
                          EXPECT_EQ(record.time, 0.125 * static_cast<double>(record.step));
                          EXPECT_EQ(std::vector<Wide>(record.state.begin(), record.state.end()),
                                    run.state());
                          EXPECT_EQ(record.energy, run.energy());
                          EXPECT_EQ(record.invariants[0].hi, run.energy().hi / 2.0);
                        }});
}

// H of the leapfrog oscillator swings by a relative (omega h)^2/4 = 1/64 and does not drift.
TEST(Integrate, SummarisesTheEnergyTheSameWayHoweverTheStepsAreDivided) {
  std::vector<RunSummary> summaries;
  for (const long long every : {0LL, 1LL, 7LL, 1000LL}) {
    Integrator run = oscillator_run();
    summaries.push_back(integrate(run, {.steps = 5000, .every = every}));
    ASSERT_TRUE(summaries.back().energy.has_value());
    EXPECT_EQ(summaries.back().energy->last, run.energy());
  }
  const EnergyStatistics& first = *summaries.front().energy;
  EXPECT_EQ(first.initial.hi, 2.0);
  EXPECT_GE(first.initial, first.min);
  EXPECT_NEAR(first.spread(), 2.0 / 64, 1e-3);
  EXPECT_NEAR(first.max_error(), 2.0 / 64, 1e-3);
  for (const RunSummary& summary : summaries) {
    EXPECT_EQ(summary.status, Status::done);
    EXPECT_EQ(summary.steps_done, 5000);
    EXPECT_EQ(summary.iterations_per_step(), 1.0);
    EXPECT_EQ(summary.energy->min, first.min);
    EXPECT_EQ(summary.energy->max, first.max);
    EXPECT_EQ(summary.energy->last, first.last);
    EXPECT_GT(summary.nanoseconds_per_step(), 0.0);
    EXPECT_GE(summary.total_seconds, summary.advance_seconds);
  }
  EXPECT_EQ(summaries[2].records, 1 + 5000 / 7);
}

TEST(Integrate, StopsAtAFailedStepWithTheLastGoodState) {
  Integrator run = oscillator_run(13);
  const RunSummary summary = integrate(run, {.steps = 1000, .every = 5});
  EXPECT_EQ(summary.status, Status::not_converged);
  EXPECT_EQ(summary.steps_done, 13);
  EXPECT_EQ(summary.records, 3);
  EXPECT_EQ(summary.last_increment, 0.125);
  EXPECT_EQ(summary.energy->last, run.energy());
}

TEST(Integrate, SaysThatItOverflowedAndReturnsNoInfinity) {
  Integrator run(oscillator_library(),
                 {.parameters = {{2.0}, {0.0}}, .h = {1e3}, .state = {{1.0}, {0.0}}});
  const RunSummary summary =
      integrate(run, {.steps = 1000, .every = 1, .on_record = [](const Record& r) {
                        EXPECT_TRUE(std::isfinite(r.state[0].hi) && std::isfinite(r.energy.hi));
                      }});
  EXPECT_EQ(summary.status, Status::overflow);
  ASSERT_TRUE(summary.energy.has_value());
  EXPECT_TRUE(std::isfinite(summary.energy->max.hi));
  EXPECT_EQ(summary.energy->last, run.energy());
  EXPECT_EQ(summary.records, summary.steps_done + 1);
}

TEST(Integrate, OutsideTheDomainFromTheStartTakesNoStep) {
  Integrator run(oscillator_library(), {.parameters = {{2.0}, {0.0}},
                                        .h = {0.1},
                                        .state = {{1e300}, {0.0}},
                                        .defined_everywhere = true});
  const RunSummary summary = integrate(run, {.steps = 10, .every = 1});
  EXPECT_EQ(summary.status, Status::overflow);
  EXPECT_EQ(summary.steps_done, 0);
  EXPECT_EQ(summary.records, 0);
  EXPECT_FALSE(summary.energy.has_value());
}

// The oscillator with another H beyond q = 0, which its steps know nothing of.
std::shared_ptr<const Library> beyond_zero(const std::string& energy) {
  PluginSource source = oscillator();
  const std::string from = "return 0.5 * z[1] * z[1]";
  source.text.replace(source.text.find(from), from.size(),
                      "if (z[0] < 0) return " + energy + ";\n  " + from);
  return load_plugin(source, find_compiler(), {}, {.directory = {}, .problem = "no cache"}).library;
}

// q = cos(2 t) on leapfrog's circle is negative first after step 7: t = 0.875 > pi/4.
struct Ended {
  RunSummary summary;
  std::vector<Wide> last_row;
  std::vector<Wide> state;
  Wide energy;

  Ended(const std::shared_ptr<const Library>& library, const InitialValues& start, long long every,
        bool end_at_jump) {
    Integrator run(library, start);
    summary = integrate(run, {.steps = 1000,
                              .every = every,
                              .end_at_jump = end_at_jump,
                              .on_record = [this](const Record& record) {
                                last_row.assign(record.state.begin(), record.state.end());
                                EXPECT_GT(record.state[0].hi, 0.0);
                              }});
    state = run.state();
    energy = run.energy();
  }
};

const InitialValues at_rest{.parameters = {{2.0}, {0.0}}, .h = {0.125}, .state = {{1.0}, {0.0}}};

// The state, its row, its energy and its number are those of the step before, however the steps
// are divided into calls.
void expect_six_steps(const Ended& run, long long every) {
  EXPECT_EQ(run.summary.steps_done, 6) << every;
  Integrator six = oscillator_run();
  (void)six.advance(6, true);
  EXPECT_EQ(run.state, six.state()) << every;
  EXPECT_GT(run.state[0].hi, 0.0);
  EXPECT_EQ(run.energy, six.energy()) << every;
  EXPECT_EQ(run.summary.energy->last, six.energy()) << every;
  EXPECT_LT(run.summary.energy->max_error(), 0.1) << every;
  EXPECT_EQ(run.summary.iterations, 6) << every;
  if (every == 1) {
    EXPECT_EQ(run.last_row, six.state());
  }
  EXPECT_EQ(run.summary.records, every == 0 ? 0 : 1 + 6 / every);
}

TEST(Integrate, AStepThatEndsWhereThereIsNoEnergyDoesNotCount) {
  for (const char* energy : {"__builtin_nan(\"\")", "__builtin_inf()", "-__builtin_inf()"}) {
    const std::shared_ptr<const Library> library = beyond_zero(energy);
    for (const long long every : {0LL, 1LL, 2LL, 100LL}) {
      const Ended run(library, at_rest, every, false);
      EXPECT_EQ(run.summary.status, Status::left_domain) << energy;
      expect_six_steps(run, every);
    }
    InitialValues defined = at_rest;
    defined.defined_everywhere = true;
    EXPECT_EQ(Ended(library, defined, 1, false).summary.status, Status::overflow);
  }
}

// H(0) = 2 is half of the energy scale |z| |grad H| = 4: 41 more is a jump, 39 more is none.
TEST(Integrate, AnEnergyErrorOfMoreThanTenScalesIsAJump) {
  const std::shared_ptr<const Library> jump = beyond_zero("2 + 40.5");
  for (const long long every : {0LL, 1LL, 2LL, 100LL}) {
    const Ended run(jump, at_rest, every, true);
    EXPECT_EQ(run.summary.status, Status::jumped);
    EXPECT_EQ(run.summary.energy_scale, 4.0);
    EXPECT_EQ(run.summary.jump, 40.5);
    expect_six_steps(run, every);
  }
  for (const bool end_at_jump : {false, true}) {
    Integrator run(beyond_zero("2 + 39.5"), at_rest);
    EXPECT_EQ(integrate(run, {.steps = 1000, .end_at_jump = end_at_jump}).status, Status::done);
  }
  Integrator run(jump, at_rest);
  EXPECT_EQ(integrate(run, {.steps = 1000}).status, Status::done);
}

// H = p^2/2 - omega^2 q^2/2.
std::shared_ptr<const Library> repulsive() {
  PluginSource source = oscillator();
  const auto replace_all = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = source.text.find(from, at)) != std::string::npos;
         at += to.size())
      source.text.replace(at, from.size(), to);
  };
  replace_all("z[1] + 0.5 * par", "z[1] - 0.5 * par");
  replace_all("run->p -= ", "run->p += ");
  replace_all("g[0] = par", "g[0] = -par");
  return load_plugin(source, find_compiler(), {}, {.directory = {}, .problem = "no cache"}).library;
}

// From beside the saddle the orbit goes far.  Leapfrog keeps p^2/2 - omega^2 q^2/2 (1 + (omega
// h)^2/4) there: the error grows with q^2, to 1/64 of the potential energy, and is no jump.
TEST(Integrate, AnErrorThatIsSmallBesideTheTermsOfHIsNoJump) {
  Integrator run(repulsive(),
                 {.parameters = {{2.0}, {0.0}}, .h = {0.125}, .state = {{1e-6}, {1e-6}}});
  const RunSummary summary = integrate(run, {.steps = 100, .end_at_jump = true});
  EXPECT_EQ(summary.status, Status::done);
  EXPECT_TRUE(run.judge().is_jump(summary.energy->max_error()));
  // Steps were repeated on the way: nothing of that is seen.
  Integrator plain(repulsive(),
                   {.parameters = {{2.0}, {0.0}}, .h = {0.125}, .state = {{1e-6}, {1e-6}}});
  const RunSummary same = integrate(plain, {.steps = 100});
  EXPECT_EQ(run.state(), plain.state());
  EXPECT_EQ(summary.iterations, same.iterations);
  EXPECT_EQ(summary.energy->max_error(), same.energy->max_error());
}

// At rest in the origin, where H = 0, there is no scale: the first step that errs gives one.
TEST(Integrate, AnOrbitWithoutAScaleTakesThatOfItsFirstTerms) {
  Integrator run(beyond_zero("3"),
                 {.parameters = {{2.0}, {0.0}}, .h = {0.125}, .state = {{-1.0}, {0.0}}});
  EXPECT_GT(run.judge().energy_scale(), 0.0);
  Integrator still(oscillator_library(),
                   {.parameters = {{2.0}, {0.0}}, .h = {0.125}, .state = {{0.0}, {0.0}}});
  EXPECT_EQ(still.judge().energy_scale(), 0.0);
  EXPECT_EQ(integrate(still, {.steps = 100, .end_at_jump = true}).status, Status::done);
}

TEST(Integrator, CountsNoStepThatFailed) {
  Integrator run = oscillator_run(10);
  EXPECT_EQ(run.advance(7, false).steps_done, 7);
  EXPECT_EQ(run.advance(25, false).steps_done, 3);
  EXPECT_EQ(run.steps_done(), 10);
  EXPECT_EQ(run.advance(25, false).steps_done, 0);
  EXPECT_EQ(run.steps_done(), 10);
}

TEST(Integrator, GoesBackBitForBit) {
  Integrator run = oscillator_run();
  (void)run.advance(17, true);
  const std::vector<Wide> there = run.state();
  (void)run.advance(100, true);
  run.go_back_to(17);
  EXPECT_EQ(run.steps_done(), 17);
  EXPECT_EQ(run.state(), there);
}

// Asked to stop when progress is reported for the first time, it stops the next time it looks: then
// progress may be reported once more, and is at the end.  Without the request it would run for
// hours.
TEST(Integrate, StopsOnRequestTheNextTimeItLooks) {
  Integrator run = oscillator_run();
  std::atomic<bool> stop = false;
  int reports = 0;
  const auto on_progress = [&](const Progress&) {
    stop = true;
    ++reports;
  };
  const RunSummary summary = integrate(run, {.steps = 10'000'000'000'000,
                                             .on_progress = on_progress,
                                             .progress_interval = std::chrono::milliseconds(20),
                                             .stop = &stop});
  EXPECT_EQ(summary.status, Status::stopped);
  EXPECT_GT(summary.steps_done, 0);
  EXPECT_LE(reports, 3);
  EXPECT_EQ(summary.energy->last, run.energy());
}

// With no time between two reports every step is one, see Note [pace].
TEST(Integrate, ReportsProgressInOrderAndAtTheEnd) {
  Integrator run = oscillator_run();
  std::vector<long long> seen;
  (void)integrate(run, {.steps = 5,
                        .on_progress =
                            [&seen](const Progress& progress) {
                              EXPECT_EQ(progress.steps, 5);
                              seen.push_back(progress.steps_done);
                            },
                        .progress_interval = std::chrono::seconds(0)});
  EXPECT_EQ(seen, (std::vector<long long>{1, 2, 3, 4, 5, 5}));
}

TEST(Integrate, RefusesNegativeNumbers) {
  Integrator run = oscillator_run();
  EXPECT_THROW((void)integrate(run, {.steps = -1}), std::invalid_argument);
  EXPECT_THROW((void)integrate(run, {.steps = 1, .every = -1}), std::invalid_argument);
}

TEST(ProgressLine, ShowsShareRateAndTimeLeftWithinTheWidth) {
  const Progress half{.steps_done = 50000, .steps = 100000, .seconds = 90.0};
  EXPECT_EQ(progress_line("pendulum", half, 79, false),
            "pendulum  [==================>                 ]   50 %  556 steps/s  1:30 left");
  EXPECT_EQ(progress_line("pendulum", half, 20, false), "pendulum   50 %  556");
  EXPECT_NE(progress_line("pendulum", half, 79, true).find("\x1b[32m"), std::string::npos);
  EXPECT_NE(progress_line("x", {.steps_done = 0, .steps = 5}, 79, false).find("? left"),
            std::string::npos);
  EXPECT_NE(progress_line("x", {.steps_done = 5, .steps = 5, .seconds = 1}, 79, false)
                .find("100 %  5 steps/s  0:00 left"),
            std::string::npos);
  for (int width = 0; width < 100; ++width) {
    EXPECT_LE(progress_line("pendulum", half, width, false).size(),
              static_cast<std::size_t>(width));
  }
}

TEST(ProgressBar, DrawsNothingWhereThereIsNoTerminal) {
  testing::internal::CaptureStderr();
  {
    ProgressBar bar("pendulum");
    EXPECT_FALSE(bar.is_visible());
    bar.update({.steps_done = 1, .steps = 2, .seconds = 1.0});
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace hamgen::runtime
