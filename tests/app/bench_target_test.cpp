// What hamgen bench answers to --target, by a clock of the test's own.
#include "app/studies/bench_target.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>

#include "app/bench_options.hpp"
#include "app/output/bench_output.hpp"
#include "app/output/bench_picture.hpp"
#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

using app::Bench;
using app::BenchMethod;
using app::BenchOptions;
using app::BenchRow;

const std::string kModels = HAMGEN_SOURCE_DIR "/hamiltonians/";

// The cost of a step of each method; of all others 1.
using Costs = std::map<std::string, double>;

// A clock that runs nothing: a step takes as many microseconds as it costs.
app::RunClock clock_of(const Costs& costs) {
  return [costs](const BenchMethod& method, const runtime::InitialValues&, long steps) {
    const auto cost = costs.find(method.spec);
    return 1e-6 * static_cast<double>(steps) * (cost == costs.end() ? 1.0 : cost->second);
  };
}

Bench bench(BenchOptions options, const Costs& costs = {}) {
  options.rounds = "1";
  options.quiet = true;
  app::BenchRequest request = app::read_bench(options);
  request.clock = clock_of(costs);
  return app::run_bench(request);
}

const BenchRow& answer_of(const Bench& bench) {
  return bench.rows.at(bench.answers.at(0).row.value());
}
const std::string& method_of(const Bench& bench, const BenchRow& row) {
  return bench.methods.at(row.method).spec;
}

// The pendulum to t = 10.
class BenchTarget : public testing::Test {
 protected:
  BenchOptions options(const std::string& schemes, const std::string& steps,
                       const std::string& target) const {
    return {.model = model_, .schemes = schemes, .h = steps, .time = "10", .target = target};
  }

 private:
  Scratch scratch_;
  std::string model_ = scratch_.write("m.ham", pendulum);
};

// Where the largest step is better than asked for, a larger one is tried.
TEST_F(BenchTarget, ALargerStepIsTriedWhereAllMeetTheTarget) {
  const Bench result = bench(options("gauss-4", "0.1,0.05", "1e-4"));
  EXPECT_GT(to_double(answer_of(result).h), 0.2);
  EXPECT_LE(answer_of(result).state_error.value(), 1e-4);
}

TEST_F(BenchTarget, ASmallerStepIsTriedWhereNoneMeetsTheTarget) {
  const Bench result = bench(options("implicit-midpoint,symplectic-euler-a", "0.2,0.1", "1e-7"));
  const BenchRow& row = answer_of(result);
  EXPECT_EQ(method_of(result, row), "implicit-midpoint");
  EXPECT_LE(row.state_error.value(), 1e-7);
  EXPECT_GE(row.state_error.value(), 0.5e-7);
}

TEST_F(BenchTarget, TheAnswerIsTheMethodThatTheClockFavours) {
  const BenchOptions both = options("implicit-midpoint,gauss-4", "0.1,0.05", "1e-4");
  for (const std::string dear : {"implicit-midpoint", "gauss-4"}) {
    const Bench result = bench(both, {{dear, 1000.0}});
    EXPECT_NE(method_of(result, answer_of(result)), dear);
  }
}

// The midpoint rule misses 1e-7 with these steps, gauss-4 does not.
TEST_F(BenchTarget, OnlyAMethodThatCanWinIsTriedFurther) {
  const BenchOptions both = options("implicit-midpoint,gauss-4", "0.1,0.05", "1e-7");
  const auto tried = [&](const Costs& costs) {
    const Bench result = bench(both, costs);
    return std::any_of(result.rows.begin() + 4, result.rows.end(), [&](const BenchRow& row) {
      return method_of(result, row) == "implicit-midpoint";
    });
  };
  EXPECT_FALSE(tried({}));
  EXPECT_TRUE(tried({{"gauss-4", 1e6}}));
}

// Of the methods that are offered rk4 is there to compare with, however fast it is.
TEST(BenchAnswer, IsNoBaseline) {
  const Scratch scratch;
  app::BenchRequest request = app::read_bench({.model = scratch.write("m.ham", pendulum),
                                               .h = "0.1",
                                               .time = "1",
                                               .target = "1e-2",
                                               .rounds = "1",
                                               .quiet = true});
  std::erase_if(request.methods, [](const app::BenchSpec& method) {
    return method.spec != "implicit-midpoint" && method.spec != "rk4";
  });
  request.clock = clock_of({{"implicit-midpoint", 1000.0}});
  request.refines = false;
  const Bench result = app::run_bench(request);
  ASSERT_EQ(result.rows.size(), 2u);
  EXPECT_EQ(method_of(result, result.rows[1]), "rk4");
  EXPECT_LT(result.rows[1].state_error.value(), 1e-2);
  EXPECT_EQ(result.answers.at(0).row, 0u);
  // But it is said that it is faster here.
  EXPECT_TRUE(contains(app::table_text(result, true), "rk4 with h = 0.1, not symplectic, takes"))
      << app::table_text(result, true);
}

// Steps as they are asked for, each of whose methods takes as long.
Bench rows_as_asked(BenchOptions options, app::Observed observed = app::Observed::state) {
  options.rounds = "1";
  options.quiet = true;
  app::BenchRequest request = app::read_bench(options);
  request.observed = observed;
  request.clock = clock_of({});
  request.refines = false;
  return app::run_bench(request);
}

// Stormer-Verlet for H = (p^2 + q^2)/2 is unstable beyond h = 2: errors grow by a factor of 1.046 a
// step here, 2.4 in twenty steps and 7000 in two hundred.
TEST(BenchAnswer, LastsTenTimesAsLong) {
  const Scratch scratch;
  const Bench result = rows_as_asked(
      {.model = scratch.write("m.ham",
                              "system oscillator\ncoordinate q\nmomentum p\nH = (p^2 + q^2)/2\n"
                              "scene start {\n  q = 1\n  p = 0\n}\n"),
       .schemes = "stormer-verlet",
       .h = "2.0005,0.25",
       .time = "40.01",
       .target = "1e100"});
  ASSERT_EQ(result.rows.size(), 2u);
  EXPECT_TRUE(result.rows[0].ok());
  EXPECT_NE(result.rows[0].unstable, "");
  EXPECT_EQ(result.rows[1].unstable, "");
  EXPECT_EQ(result.answers.at(0).row, 1u);
}

// A step of 40/9 of the chain is beyond what blanes-moan-rkn-6 is stable for: its energy error is a
// thousandth of the scale after 450 steps, ten times the 45 of the row, and it blows up at step
// 1120.
TEST(BenchAnswer, LastsFiveThousandSteps) {
  const Bench result = rows_as_asked({.model = kModels + "fput.ham",
                                      .schemes = "blanes-moan-rkn-6",
                                      .h = "40/9,8/3",
                                      .time = "200",
                                      .target = "1e-3"});
  ASSERT_EQ(result.rows.size(), 2u);
  EXPECT_LE(result.rows[0].state_error.value(), 1e-3);
  EXPECT_NE(result.rows[0].unstable, "");
  EXPECT_EQ(result.rows[1].unstable, "");
  EXPECT_EQ(result.answers.at(0).row, 1u);
}

// Two steps of gauss-16 across the pendulum's period have an energy error that is small by chance.
TEST(BenchAnswer, OfAnEnergyErrorIsWhatLasts) {
  const Bench result = rows_as_asked({.model = kModels + "pendulum.ham",
                                      .schemes = "gauss-16",
                                      .h = "10,2",
                                      .time = "20",
                                      .target = "1e-8"},
                                     app::Observed::energy);
  ASSERT_EQ(result.rows.size(), 2u);
  EXPECT_LE(result.rows[0].relative_energy_error().value(), 1e-8);
  EXPECT_GT(result.rows[0].lasting_energy_error().value(), 1e-8);
  EXPECT_EQ(result.answers.at(0).row, 1u);
}

// Stopped in the third measurement, it has the rows of the two before and says so.
TEST(BenchStopped, KeepsTheRowsThatWereMeasured) {
  const Scratch scratch;
  app::BenchRequest request = app::read_bench({.model = scratch.write("m.ham", pendulum),
                                               .schemes = "stormer-verlet",
                                               .h = "0.4,0.2,0.1,0.05",
                                               .time = "10",
                                               .quiet = true});
  std::atomic<bool> stop = false;
  request.stop = &stop;
  int measured = 0;
  request.clock = [&](const BenchMethod&, const runtime::InitialValues&, long steps) {
    if (++measured == 3) stop = true;
    return 1e-6 * static_cast<double>(steps);
  };
  const Bench result = app::run_bench(request);
  EXPECT_TRUE(result.is_stopped);
  ASSERT_EQ(result.rows.size(), 2u);
  for (const BenchRow& row : result.rows) EXPECT_TRUE(row.ok()) << row.outcome;
  EXPECT_TRUE(contains(app::table_text(result, true), "stopped before all was measured"));
}

// A method m takes m + 1 microseconds; three have errors that fall with their time, the last is a
// baseline, the others are slow and bad.
TEST(BenchPicture, OfManyMethodsShowsThoseThatAreSomewhereTheQuickest) {
  Bench bench{.observed = app::Observed::state};
  constexpr std::size_t count = 12;
  for (std::size_t m = 0; m < count; ++m) {
    BenchMethod method{.spec = "method " + std::to_string(m)};
    method.is_baseline = m + 1 == count;
    bench.methods.push_back(std::move(method));
    BenchRow row{.method = m, .h = Rational(1), .steps = 1, .outcome = "done"};
    const bool wins = m == 3 || m == 5 || m == 7;
    row.state_error = wins ? std::pow(10.0, -static_cast<double>(m)) : 1.0;
    row.samples = {1e-6 * static_cast<double>(m + 1)};
    bench.rows.push_back(std::move(row));
  }
  const auto drawn = [&bench] {
    std::vector<std::string> labels;
    for (const app::PlotSeries& each : app::bench_panel(bench, app::Observed::state).series)
      labels.push_back(each.label);
    return labels;
  };
  EXPECT_EQ(drawn(), (std::vector<std::string>{"method 0", "method 3", "method 5", "method 7",
                                               "method 11"}));
  bench.methods.resize(8);
  bench.rows.resize(8);
  EXPECT_EQ(drawn().size(), 8u);
}

// The two largest steps take longer than the third and are worse, though not each of them than the
// next: a solver that hardly converges.
TEST(BenchPicture, LeavesOutLargeStepsThatASmallerOneBeats) {
  Bench bench{.observed = app::Observed::state};
  bench.methods.push_back(BenchMethod{.spec = "method"});
  long steps = 1;
  for (const auto& [time, error] :
       {std::pair{2.8e-5, 1e-2}, {2.9e-5, 1e-4}, {3e-6, 1e-8}, {4e-6, 1e-12}}) {
    BenchRow row{.method = 0, .h = Rational(1, steps), .steps = steps, .outcome = "done"};
    ++steps;
    row.state_error = error;
    row.samples = {time};
    bench.rows.push_back(std::move(row));
  }
  const app::PlotPanel panel = app::bench_panel(bench, app::Observed::state);
  ASSERT_EQ(panel.series.size(), 1u);
  ASSERT_EQ(panel.series[0].points.size(), 2u);
  EXPECT_EQ(panel.series[0].points[0].y, 1e-8);
}

// The step of the answer for one method.
double answered_step(const BenchOptions& options) { return to_double(answer_of(bench(options)).h); }

// The search ends within 3 % of the border, so that a step 4 % larger misses, where the error is a
// power of h.  Of the double pendulum it changes its sign near the border: no more is said there
// than that a step above the given one is found.
TEST(BenchTargetOfAModel, TheStepIsNearlyTheLargestOne) {
  struct Case {
    std::string model, scheme, target, steps;
    double given;  // the largest given step that meets the target
    bool is_power = true;
  };
  const std::vector<Case> cases = {
      {"pendulum.ham", "kahan-li-8-verlet", "1e-10", "0.8,0.4,0.2,0.1", 0.8},
      {"pendulum.ham", "kahan-li-8-verlet", "1e-9", "0.2,0.1,0.05", 0.2},
      {"morse.ham", "blanes-moan-rkn-6", "1e-6", "0.4,0.2,0.1,0.05", 0.2},
      {"double_pendulum.ham", "gauss-8", "1e-9", "0.16,0.08,0.04", 0.08, false}};
  for (const auto& [model, scheme, target, steps, given, is_power] : cases) {
    BenchOptions options{.model = kModels + model, .schemes = scheme, .h = steps, .target = target};
    const double h = answered_step(options);
    EXPECT_GT(h, 1.1 * given) << model << ' ' << target;
    if (!is_power) continue;
    options.h = std::to_string(1.04 * h);
    options.target.clear();
    EXPECT_GT(bench(options).rows.at(0).state_error.value(), std::stod(target)) << model << h;
  }
}

TEST(BenchTargetOfAModel, AWeakerTargetIsReachedWithALargerStep) {
  double before = 0.0;
  for (const char* target : {"1e-8", "1e-7", "1e-6", "1e-5", "1e-4"}) {
    const double h = answered_step({.model = kModels + "morse.ham",
                                    .schemes = "blanes-moan-rkn-6",
                                    .h = "0.4,0.2,0.1",
                                    .target = target});
    EXPECT_GT(h, before) << target;
    before = h;
  }
}

// The error of omelyan-4 for the Morse oscillator is beyond 1e-4 from h = 0.16 on and changes its
// sign near h = 0.29, where it is below again.
TEST(BenchTargetOfAModel, ALargeStepWhoseErrorIsSmallByChanceIsFound) {
  BenchOptions options{.model = kModels + "morse.ham", .schemes = "omelyan-4", .h = "0.2,0.15,0.1"};
  options.time = "50";
  options.target = "1e-4";
  const Bench result = bench(options);
  ASSERT_EQ(method_of(result, result.rows[0]), "omelyan-4");
  EXPECT_GT(result.rows[0].state_error.value(), 1e-4);
  EXPECT_GT(to_double(answer_of(result).h), 0.25);
  EXPECT_LE(answer_of(result).state_error.value(), 1e-4);
}

// Those are tried with which the method would be the quickest, and no more than two octaves.
TEST(BenchLargerSteps, AreTriedOfAMethodThatTheyMakeTheQuickest) {
  app::StepSearch search{.target = 1e-4};
  EXPECT_TRUE(app::larger_steps(search).empty());
  search.samples = {{.h = 0.1, .error = 1e-5, .cost = 1.0}, {.h = 0.2, .error = 1e-3, .cost = 0.5}};
  search.best_cost = 1.0;
  const std::vector<double> all = app::larger_steps(search);
  ASSERT_EQ(all.size(), 24u);
  EXPECT_DOUBLE_EQ(all.front(), 0.4);
  EXPECT_TRUE(std::ranges::is_sorted(all, std::greater{}));
  EXPECT_GT(all.back(), 0.1);
  search.best_cost = 0.5;
  const std::vector<double> some = app::larger_steps(search);
  ASSERT_FALSE(some.empty());
  EXPECT_EQ(some.size(), 12u);
  EXPECT_GT(some.back(), 0.2);
  search.best_cost = 0.25;
  EXPECT_TRUE(app::larger_steps(search).empty());
}

// Steps that missed on the way are no rows and so not drawn either; a method has at most one more.
// A step costs as many gradients as it takes, of gauss-8 four in each of about six iterations.
TEST(BenchTargetOfAModel, OnlyTheStepThatMeetsTheTargetIsShown) {
  const std::vector<BenchRow> rows =
      bench({.model = kModels + "pendulum.ham",
             .schemes = "kahan-li-8-verlet,blanes-moan-6,gauss-8",
             .h = "0.4,0.2",
             .target = "1e-9"},
            {{"kahan-li-8-verlet", 17}, {"blanes-moan-6", 10}, {"gauss-8", 24}})
          .rows;
  constexpr std::size_t given = 6;
  EXPECT_GT(rows.size(), given);
  EXPECT_LE(rows.size(), given + 3);
  for (std::size_t i = given; i < rows.size(); ++i) EXPECT_LE(rows[i].state_error.value(), 1e-9);
}

}  // namespace
}  // namespace hamgen::app_test
