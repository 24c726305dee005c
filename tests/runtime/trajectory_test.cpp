#include "runtime/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "runtime/progress.hpp"
#include "tests/runtime/oscillator.hpp"

namespace hamgen::runtime {
namespace {

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
                          EXPECT_EQ(std::vector<double>(record.state.begin(), record.state.end()),
                                    run.rounded_state());
                          EXPECT_EQ(record.energy, run.energy());
                          EXPECT_EQ(record.invariants[0], run.energy() / 2.0);
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
  EXPECT_EQ(first.initial, 2.0);
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

TEST(Integrate, WithoutWatchingKnowsTheEnergyOfTheStartTheRecordsAndTheEnd) {
  Integrator run = oscillator_run();
  const RunSummary summary = integrate(run, {.steps = 3, .watch_energy = false});
  ASSERT_TRUE(summary.energy.has_value());
  EXPECT_EQ(summary.energy->last, run.energy());
  EXPECT_EQ(summary.energy->max, 2.0);
}

TEST(Integrate, StopsAtAFailedStepWithTheLastGoodState) {
  Integrator run = oscillator_run(13);
  const RunSummary summary = integrate(run, {.steps = 1000, .every = 5, .watch_energy = false});
  EXPECT_EQ(summary.status, Status::not_converged);
  EXPECT_EQ(summary.steps_done, 13);
  EXPECT_EQ(summary.records, 3);
  EXPECT_EQ(summary.last_increment, 0.125);
  EXPECT_EQ(summary.energy->last, run.energy());
}

TEST(Integrate, SaysThatItOverflowedAndReturnsNoInfinity) {
  for (const bool watch : {false, true}) {
    Integrator run(oscillator_library(),
                   {.parameters = {{2.0}, {0.0}}, .h = {1e3}, .state = {{1.0}, {0.0}}});
    const RunSummary summary = integrate(
        run, {.steps = 1000, .every = 1, .watch_energy = watch, .on_record = [](const Record& r) {
                EXPECT_TRUE(std::isfinite(r.state[0]) && std::isfinite(r.energy));
              }});
    EXPECT_EQ(summary.status, Status::not_finite);
    ASSERT_TRUE(summary.energy.has_value());
    EXPECT_TRUE(std::isfinite(summary.energy->max));
    EXPECT_TRUE(std::isfinite(summary.energy->last));
  }
}

TEST(Integrate, OutsideTheDomainFromTheStartTakesNoStep) {
  Integrator run(oscillator_library(),
                 {.parameters = {{2.0}, {0.0}}, .h = {0.1}, .state = {{1e300}, {0.0}}});
  const RunSummary summary = integrate(run, {.steps = 10, .every = 1});
  EXPECT_EQ(summary.status, Status::not_finite);
  EXPECT_EQ(summary.steps_done, 0);
  EXPECT_EQ(summary.records, 0);
  EXPECT_FALSE(summary.energy.has_value());
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
