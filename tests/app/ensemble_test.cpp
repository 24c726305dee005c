// hamgen ensemble: every row is that of a run of its own, whoever did it when.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "app/studies/ensemble_plan.hpp"
#include "app/studies/philox.hpp"
#include "generator/base/diagnostic.hpp"
#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result;
  std::size_t begin = 0;
  for (std::size_t comma = 0; comma != std::string::npos; begin = comma + 1) {
    comma = line.find(',', begin);
    result.push_back(line.substr(begin, comma - begin));
  }
  return result;
}

// By the names of the columns.
using Row = std::map<std::string, std::string>;

std::vector<Row> rows_of(const std::string& path) {
  std::vector<Row> rows;
  std::vector<std::string> names;
  for (const std::string& line : lines(read(path))) {
    if (line.starts_with('#')) continue;
    const std::vector<std::string> values = cells(line);
    if (names.empty()) {
      names = values;
      continue;
    }
    EXPECT_EQ(values.size(), names.size()) << line;
    rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) rows.back()[names[i]] = values[i];
  }
  return rows;
}

std::vector<std::string> ensemble(const std::string& model, const std::string& output,
                                  std::vector<std::string> more) {
  more.insert(more.begin(), {"ensemble", model, "--quiet", "-o", output});
  return more;
}

// The vectors that the authors publish (kat_vectors of Random123).
TEST(Philox, HasTheKnownValues) {
  using Four = std::array<std::uint32_t, 4>;
  EXPECT_EQ(app::philox({0, 0, 0, 0}, {0, 0}),
            (Four{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(app::philox({~0U, ~0U, ~0U, ~0U}, {~0U, ~0U}),
            (Four{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(app::philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Four{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(EnsemblePlan, GoesThroughRowsThenAxesThenDraws) {
  app::EnsemblePlan plan;
  plan.table = {.path = "", .digest = "", .names = {"a"}, .values = {5.0, 6.0}};
  plan.axes = {{"b", 0.0, 1.0, 3}, {"c", -1.0, 1.0, 2}};
  plan.draws = {{"d", app::Distribution::uniform, 2.0, 3.0}};
  plan.draws_each = 2;
  ASSERT_EQ(plan.count(), 24);
  std::vector<double> values(4);
  plan.values(0, values);
  EXPECT_EQ((std::vector<double>{values[0], values[1], values[2]}), (std::vector{5.0, 0.0, -1.0}));
  const double drawn = values[3];
  EXPECT_TRUE(drawn > 2.0 && drawn < 3.0);
  plan.values(1, values);
  EXPECT_EQ(values[1], 0.0);
  EXPECT_NE(values[3], drawn);
  plan.values(2 * 2, values);
  EXPECT_EQ(values[1], 1.0);
  plan.values(2 * 3, values);
  EXPECT_EQ(values[2], 1.0);
  plan.values(23, values);
  EXPECT_EQ((std::vector<double>{values[0], values[1], values[2]}), (std::vector{6.0, 1.0, 1.0}));
  plan.seed = 1;
  plan.values(0, values);
  EXPECT_NE(values[3], drawn);
}

// Of N values of variance 1 the mean is within 5/sqrt(N) of its own, the variance within
// 5 sqrt(2/N).
TEST(EnsemblePlan, DrawsFromTheLawsItNames) {
  app::EnsemblePlan plan;
  plan.draws = {{"u", app::Distribution::uniform, -std::sqrt(3.0), std::sqrt(3.0)},
                {"n", app::Distribution::normal, 7.0, 1.0}};
  plan.draws_each = 40000;
  double sum[2] = {}, squares[2] = {}, product = 0.0;
  long long beyond = 0;
  std::vector<double> values(2);
  for (long long i = 0; i < plan.count(); ++i) {
    plan.values(i, values);
    values[1] -= 7.0;
    for (int k = 0; k < 2; ++k) {
      sum[k] += values[k];
      squares[k] += values[k] * values[k];
    }
    product += values[0] * values[1];
    beyond += std::abs(values[1]) > 2.0 ? 1 : 0;
    EXPECT_LE(std::abs(values[0]), std::sqrt(3.0));
  }
  const double n = 40000;
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(sum[k] / n, 0.0, 5 / std::sqrt(n));
    EXPECT_NEAR(squares[k] / n, 1.0, 5 * std::sqrt(2 / n));
  }
  EXPECT_NEAR(product / n, 0.0, 5 / std::sqrt(n));
  // P(|x| > 2) = 0.0455 of a normal one.
  EXPECT_NEAR(static_cast<double>(beyond) / n, 0.0455, 5 * std::sqrt(0.0455 / n));
}

TEST(EnsembleTable, SaysWhichLineIsWrong) {
  const Scratch scratch;
  const auto said = [&](const std::string& text) -> std::string {
    try {
      static_cast<void>(app::read_ensemble_table(scratch.write("x.csv", text)));
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(said("# made by\n\"q\", p\r\n1, -2e3\r\n+3,4\n\n"), "");
  EXPECT_TRUE(contains(said("q,p\n1,2\n3\n"), "x.csv:3: 1 cells for 2 names"));
  EXPECT_TRUE(contains(said("q\n1\nnan\n"), "x.csv:3: 'nan' is no finite number"));
  EXPECT_TRUE(contains(said("q\n1e999\n"), "x.csv:2"));
  EXPECT_TRUE(contains(said("q,p\n"), "there are no rows"));
  EXPECT_TRUE(contains(said(""), "there are no rows"));
}

TEST(Ensemble, HasTheRowsOfRunsOfTheirOwn) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string output = scratch.path("x.csv");
  ASSERT_EQ(hamgen(ensemble(model, output,
                            {"--over", "q=0.5:3:4,eps=0.01:0.9:5", "--random", "p=normal(0,0.1)",
                             "--statistics", "energy, c = cos(q), p", "--every", "3"}))
                .status,
            0);
  const std::vector<Row> rows = rows_of(output);
  ASSERT_EQ(rows.size(), 20U);
  for (const std::size_t i : {std::size_t{0}, std::size_t{7}, std::size_t{19}}) {
    const Row& row = rows[i];
    EXPECT_EQ(row.at("index"), std::to_string(i));
    const std::string trajectory = scratch.path("t.csv");
    const Result run = hamgen({"run", model, "--quiet", "--json", "--set", "eps=" + row.at("eps"),
                               "--initial", "q=" + row.at("q_0") + ",p=" + row.at("p_0"), "--every",
                               "3", "--observe", "q, p, energy, c = cos(q)", "-o", trajectory});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(row.at("status"), "done");
    EXPECT_EQ(row.at("steps"), "1000");
    const std::vector<Row> states = rows_of(trajectory);
    // The state after 999 steps is the last one of these, that after 1000 is the JSON's.
    const auto value = [&row](const char* name) { return std::stod(row.at(name)); };
    EXPECT_EQ(value("q"), json["state"]["q"][0].get<double>()) << run.out;
    EXPECT_EQ(value("p"), json["state"]["p"][0].get<double>());
    EXPECT_EQ(value("H_error"), json["energy"]["max_error"].get<double>());
    EXPECT_EQ(value("H_scale"), json["energy"]["scale"].get<double>());
    for (const auto& [column, name] :
         {std::pair{"H", "energy"}, std::pair{"c", "c"}, std::pair{"p", "p"}}) {
      double least = 1e300, largest = -1e300, sum = 0.0;
      for (const Row& state : states) {
        const double x = std::stod(state.at(column));
        least = std::min(least, x);
        largest = std::max(largest, x);
        sum += x;
      }
      const std::string statistic = name;
      EXPECT_EQ(std::stod(row.at(statistic + "_min")), least);
      EXPECT_EQ(std::stod(row.at(statistic + "_max")), largest);
      // 334 numbers of at most 1, added without compensation.
      EXPECT_NEAR(std::stod(row.at(statistic + "_mean")), sum / static_cast<double>(states.size()),
                  334 * 1.2e-16);
    }
  }
}

TEST(Ensemble, HasTheSameBytesWhateverTheThreads) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  std::string one;
  for (const char* threads : {"1", "2", "5"}) {
    const std::string output = scratch.path("x.csv");
    std::vector<std::string> words =
        ensemble(model, output, {"--over", "q=0:3:1500", "--steps", "100", "--threads", threads});
    Result result = hamgen(words);
    if (contains(result.err, "without oneTBB"))
      GTEST_SKIP() << "built without oneTBB: one thread alone";
    ASSERT_EQ(result.status, 0) << result.err;
    if (one.empty()) one = read(output);
    EXPECT_EQ(read(output), one) << threads;
  }
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"pendulum.ham", "x.csv"}));
}

// Each ends in its own way, and none ends the others.
TEST(Ensemble, SaysHowEachTrajectoryEnded) {
  const Scratch scratch;
  const std::string model = scratch.write("collapse.ham", collapse);
  const std::string mark = "\xEF\xBB\xBF";  // as spreadsheets begin their files
  const std::string starts = scratch.write("s.csv", mark + "q,p\n1,0\n0,0\n5,1\n");
  const Result result = hamgen({"ensemble", model, "--from", starts, "--steps", "100", "-o",
                                scratch.path("x.csv"), "--json", "--quiet"});
  EXPECT_EQ(result.status, 0) << result.err;
  const std::vector<Row> rows = rows_of(scratch.path("x.csv"));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_NE(rows[0].at("status"), "done");
  EXPECT_LT(std::stod(rows[0].at("t")), 0.8);  // it ends at 0.7071
  EXPECT_GT(std::stod(rows[0].at("t")), 0.6);
  EXPECT_EQ(rows[1].at("status"), "undefined");
  EXPECT_EQ(rows[1].at("q"), "");
  EXPECT_EQ(rows[2].at("status"), "done");
  EXPECT_EQ(rows[2].at("steps"), "100");
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["trajectories"], 3);
  EXPECT_EQ(json["ended"]["done"], 1);
  // Of the one that is done.
  EXPECT_DOUBLE_EQ(json["max_relative_energy_error"].get<double>(),
                   std::stod(rows[2].at("H_error")) / std::stod(rows[2].at("H_scale")));
  EXPECT_EQ(json["ended"]["undefined"], 1);
}

// Values the scene computes from one that is varied follow it.
TEST(Ensemble, ComputesWhatDependsOnAVariedParameter) {
  const Scratch scratch;
  const std::string model =
      scratch.write("m.ham",
                    "system m\ncoordinate q\nmomentum p\nparameter a = 1\nH = (p^2 + a*q^2)/2\n"
                    "scene s { q = 2*a; p = sqrt(a); h = 0.1/a; steps = 10*a }\n");
  ASSERT_EQ(hamgen(ensemble(model, scratch.path("x.csv"), {"--over", "a=1:3:3"})).status, 0);
  const std::vector<Row> rows = rows_of(scratch.path("x.csv"));
  ASSERT_EQ(rows.size(), 3U);
  for (int a = 1; a <= 3; ++a) {
    const Row& row = rows[static_cast<std::size_t>(a - 1)];
    const Result run = hamgen({"run", model, "--quiet", "--json", "--set", "a=" + row.at("a")});
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(row.at("steps"), std::to_string(10 * a));
    EXPECT_EQ(std::stod(row.at("q")), json["state"]["q"][0].get<double>());
  }
}

TEST(Ensemble, RefusesSoManyStepsOfNoStatistics) {
  const Scratch scratch;
  const Result result = hamgen({"ensemble", HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham",
                                "--over", "q=0:1:3", "--every", "5", "-o", scratch.path("x.csv")});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "--every 5: statistics")) << result.err;
}

TEST(Ensemble, RefusesWhatMakesNoSense) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string output = scratch.path("x.csv");
  const auto refused = [&](std::vector<std::string> more, std::string_view part) {
    const Result result = hamgen(ensemble(model, output, std::move(more)));
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_TRUE(contains(result.err, part)) << result.err;
  };
  refused({}, "--over, --random or --from");
  refused({"--over", "q=0:1:1000000,p=0:1:1000000"}, "1e+12 trajectories");
  refused({"--over", "q=0:1:1"}, "not an integer between 2");
  refused({"--over", "q=1:0:5"}, "LOW < HIGH");
  refused({"--over", "q=0:1"}, "LOW:HIGH:COUNT");
  refused({"--over", "epps=0:1:3"}, "did you mean 'eps'?");
  refused({"--over", "q=0:1:3", "--random", "q=normal(0,1)"}, "q is given its values twice");
  refused({"--over", "eps=0:1:3", "--fold", "eps"}, "cannot be burnt in");
  refused({"--random", "q=normal(0,-1)"}, "DEVIATION > 0");
  refused({"--random", "q=gamma(1,2)"}, "uniform(A,B)");
  refused({"--over", "q=0:1:3", "--draws", "5"}, "for --random");
  refused({"--over", "q=0:1:3", "--statistics", "r"}, "r");
  refused({"--over", "q=0:1:3", "--threads", "0"}, "not an integer");
  refused({"--from", scratch.write("s.csv", "q,x\n1,2\n")}, "column x");
  EXPECT_EQ(hamgen({"ensemble", model, "--over", "q=0:1:3", "-o", "x.txt"}).status, 2);
  EXPECT_EQ(hamgen({"ensemble", model, "--over", "q=0:1:3"}).status, 2);
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"pendulum.ham", "s.csv"}));
}

}  // namespace
}  // namespace hamgen::app_test
