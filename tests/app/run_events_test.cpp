// hamgen run: events of the model, rows at times, pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/run_results.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

// q = cos(t), p = -sin(t).
constexpr const char* kTurns =
    "system turns\ncoordinate q\nmomentum p\nparameter line = 1/2\nH = p^2/2 + q^2/2\n"
    "event left = q - line falling  # of the line\nevent through = q\nevent never = q - 3\n"
    "scene unit { q = 1; h = 0.1; steps = 100 }\n";

// A driven system has a t of its own: no two columns have one name.
TEST(RunEvents, SayWhatElapsedOfASystemThatHasATime) {
  const Scratch scratch;
  const std::string model =
      scratch.write("m.ham",
                    "system m\ncoordinate q\nmomentum p\ntime t\nH = p^2/2 + (1 + cos(t)/5)*q^2/2\n"
                    "event e = t - 4\nscene s { q = 1; t = 3; h = 0.1; steps = 20 }\n");
  const Result result =
      hamgen({"run", model, "--interpret", "--quiet", "--events", scratch.path("e.csv")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(read(scratch.path("e.csv")), "\nevent,elapsed,steps,fraction,q,t,p,p_t\n"))
      << read(scratch.path("e.csv"));
  for (const auto& [words, ending] : {std::pair<std::vector<std::string>, const char*>(
                                          {"--events", scratch.path("e.csv")}, "elapsed = 2: q"),
                                      {{"--until", "t - 4"}, "elapsed = 1: q"}}) {
    std::vector<std::string> all = {"run", model, "--interpret"};
    all.insert(all.end(), words.begin(), words.end());
    const std::string said = hamgen(all).err;
    EXPECT_TRUE(contains(said, "at elapsed = 1") || contains(said, "at elapsed = 0.99999")) << said;
    EXPECT_TRUE(contains(said, ending)) << said;
  }
  const Result starts =
      hamgen({"ensemble", model, "--over", "q=1:2:2", "--quiet", "-o", scratch.path("ends.csv")});
  ASSERT_EQ(starts.status, 0) << starts.err;
  EXPECT_TRUE(contains(read(scratch.path("ends.csv")), ",elapsed,q,t,p,p_t,"))
      << read(scratch.path("ends.csv"));
}

TEST(Events, AreFoundInTheirOrderWithTimesAndStates) {
  const Scratch scratch;
  const std::string model = scratch.write("turns.ham", kTurns);
  const std::vector<std::string> words = {"run", model, "--scheme", "gauss-8", "--interpret"};
  auto with = [&words](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return hamgen(more);
  };
  const Result result = with({"--json", "--events", scratch.path("e.csv")});
  ASSERT_EQ(result.status, 0) << result.err;
  const json events = json::parse(result.out)["events"];
  EXPECT_EQ(events["left"]["count"], 2);
  EXPECT_NEAR(events["left"]["first"], std::numbers::pi / 3, 1e-13);
  EXPECT_EQ(events["through"]["count"], 3);
  EXPECT_EQ(events["never"]["count"], 0);
  EXPECT_TRUE(events["never"]["first"].is_null());
  EXPECT_NEAR(events["never"]["max"], -2, 1e-12);
  EXPECT_TRUE(contains(result.err, "never: never; after each step it was between -")) << result.err;

  std::vector<std::string> rows;
  for (const std::string& line : lines(read(scratch.path("e.csv")))) {
    if (!line.empty() && line.front() != '#') rows.push_back(line);
  }
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(rows[0], "event,t,steps,fraction,q,p");
  const double times[] = {std::numbers::pi / 3, std::numbers::pi / 2, 1.5 * std::numbers::pi,
                          std::numbers::pi / 3 + 2 * std::numbers::pi, 2.5 * std::numbers::pi};
  const char* names[] = {"left", "through", "through", "left", "through"};
  for (std::size_t i = 0; i < 5; ++i) {
    const std::string& row = rows[i + 1];
    EXPECT_TRUE(row.starts_with(std::string(names[i]) + ",")) << row;
    EXPECT_NEAR(std::stod(row.substr(row.find(',') + 1)), times[i], 1e-12);
  }
  // The same as JSON, and up to an event that ends the run.
  ASSERT_EQ(with({"--quiet", "--events", scratch.path("e.json"), "--until", "through"}).status, 0);
  const json file = json::parse(read(scratch.path("e.json")));
  ASSERT_EQ(file["events"].size(), 2U);
  EXPECT_EQ(file["events"][1]["event"], "through");
  EXPECT_NEAR(file["events"][1]["p"], -1, 1e-13);
}

TEST(Events, AreWantedByAName) {
  const Scratch scratch;
  const std::string model = scratch.write("turns.ham", kTurns);
  const Result wrong = hamgen({"run", model, "--events", "e.txt"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(contains(wrong.err, "ends in .csv or .json")) << wrong.err;
  const Result none = hamgen(
      {"run", HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham", "--events", scratch.path("e.csv")});
  EXPECT_EQ(none.status, 2);
  EXPECT_TRUE(contains(none.err, "pendulum has no event")) << none.err;
  EXPECT_EQ(scratch.names(), std::vector<std::string>{"turns.ham"});
}

struct Times {
  Csv csv;
  Result result;
};

Times rows_at(const std::vector<std::string>& options) {
  const Scratch scratch;
  std::vector<std::string> words = {
      "run", scratch.write("turns.ham", kTurns), "--scheme", "gauss-8", "--quiet", "-o", "-"};
  words.insert(words.end(), options.begin(), options.end());
  Times times{.csv = {}, .result = hamgen(words)};
  if (times.result.status == 0) times.csv = read_csv(times.result.out);
  return times;
}

TEST(Times, BetweenStepsHaveTheStatesOfPartsOfSteps) {
  const Times times = rows_at({"--at", "0, 2*pi, 1, 0.3, 10", "--interpret"});
  ASSERT_EQ(times.result.status, 0) << times.result.err;
  ASSERT_EQ(times.csv.rows.size(), 5U);
  for (const auto& row : times.csv.rows) EXPECT_NEAR(row[2], std::cos(row[1]), 1e-12);
  EXPECT_EQ(times.csv.rows[1][1], 0.3);
  EXPECT_EQ(times.csv.rows[1][0], 3);  // the step that ends there
  EXPECT_EQ(times.csv.rows[3][0], 62);
  const Times every = rows_at({"--every-time", "1/4", "--interpret"});
  ASSERT_EQ(every.csv.rows.size(), 41U);
  EXPECT_EQ(every.csv.rows[7][1], 1.75);
  EXPECT_NEAR(every.csv.rows[7][2], std::cos(1.75), 1e-12);
}

// On the steps' own times the rows are those of the steps, bit for bit: by compiled code, and by
// none.
TEST(Times, ChangeNothingOfTheOrbit) {
  const Times plain = rows_at({});
  for (const char* how : {"--whole", "--interpret"}) {
    const Times looked = rows_at({"--every-time", "1/20", how});
    ASSERT_EQ(looked.csv.rows.size(), 201U) << looked.result.err;
    for (std::size_t i = 0; i < plain.csv.rows.size(); ++i)
      EXPECT_EQ(looked.csv.rows[2 * i], plain.csv.rows[i]) << i << how;
  }
}

TEST(Times, AreThoseOfTheRun) {
  for (const auto& [options, words] :
       {std::pair<std::vector<std::string>, std::string>{{"--at", "11"},
                                                         "from 0 to 10 after its start"},
        {{"--at", "-1"}, "from 0 to 10 after its start"},
        {{"--at", "x"}, "unknown name 'x'"},
        {{"--every-time", "0"}, "beyond 0"},
        {{"--every-time", "1e-9"}, "more than 10000000 rows"},
        {{"--every-time", "1", "--at", "1"}, "both say when"},
        {{"--every-time", "1", "--every", "2"}, "leave one of them out"}}) {
    const Times refused = rows_at(options);
    EXPECT_NE(refused.result.status, 0) << options[1];
    EXPECT_TRUE(contains(refused.result.err, words)) << refused.result.err;
  }
}

TEST(Pictures, AreDrawnByARunAndFromItsFile) {
  const Scratch scratch;
  const std::string model = HAMGEN_SOURCE_DIR "/hamiltonians/henon_heiles.ham";
  ASSERT_EQ(hamgen({"run", model, "--interpret", "--steps", "300", "--quiet", "-o",
                    scratch.path("o.csv"), "--plot", scratch.path("run.svg")})
                .status,
            0);
  ASSERT_EQ(hamgen({"plot", scratch.path("o.csv"), "-o", scratch.path("o.svg"), "--quiet"}).status,
            0);
  for (const char* picture : {"run.svg", "o.svg"}) {
    const std::string text = read(scratch.path(picture));
    EXPECT_TRUE(contains(text, "</svg>"));
    EXPECT_TRUE(contains(text, "q2 over q1"));
    EXPECT_TRUE(contains(text, "momenta"));
    EXPECT_TRUE(contains(text, "energy error"));
  }
  EXPECT_TRUE(contains(read(scratch.path("o.gp")), "# Drawn by: gnuplot"));
  ASSERT_EQ(hamgen({"plot", scratch.path("o.csv"), "-o", scratch.path("c.svg"), "--quiet",
                    "--columns", "q1:q2:p1, H, energy_error"})
                .status,
            0);
  EXPECT_TRUE(contains(read(scratch.path("c.svg")), "seen along the diagonal"));
}

TEST(Pictures, OfAFileThatIsNoneAreRefusedWithThePlace) {
  const Scratch scratch;
  const std::string head = "# made by   hamgen 0.1.0\nstep,t,q,p,H\n0,0,1,0,0.5\n";
  const auto said = [&scratch](const std::string& text, const std::string& columns = "q") {
    const Result result = hamgen(
        {"plot", scratch.write("t.csv", text), "-o", scratch.path("t.svg"), "--columns", columns});
    return std::to_string(result.status) + " " + result.err;
  };
  EXPECT_TRUE(said(head + "# status    done\n").starts_with("0 ")) << said(head);
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_TRUE(said(mark + head + "# status    done\n").starts_with("0 ")) << said(mark + head);
  EXPECT_TRUE(contains(said(head), "0 hamgen: warning: ")) << said(head);
  EXPECT_TRUE(contains(said(head + "1,0.1,0.99"), "t.csv:4: the last line has no end"));
  EXPECT_TRUE(contains(said(head + "1,0.1,0.99\n"),
                       "t.csv:4: 3 cells, where the line of names "
                       "has 5"));
  EXPECT_TRUE(contains(said(head + "1,0.1,x,0,1\n"), "t.csv:4: 'x' in column q is no number"));
  EXPECT_TRUE(contains(said(""), "the file is empty"));
  EXPECT_TRUE(contains(said("# made by\n"), "no rows"));
  EXPECT_TRUE(contains(said(head, "qq"), "did you mean 'q'?"));
  EXPECT_TRUE(contains(said(head, "q:p:t:H"), "more than three axes"));
  const Result missing = hamgen({"plot", scratch.path("none.csv"), "-o", scratch.path("t.svg")});
  EXPECT_EQ(missing.status, 2);
  EXPECT_TRUE(contains(missing.err, "cannot read")) << missing.err;
}

TEST(Run, WritesATrajectoryAsCsvOnly) {
  const std::string model = HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham";
  for (const auto& [name, words] : {std::pair{"x.svg", "--plot x.svg"},
                                    {"x.json", "-o x.csv"},
                                    {"x.h5", "its name ends in .csv"}}) {
    const Result result = hamgen({"run", model, "-o", name});
    EXPECT_EQ(result.status, 2);
    EXPECT_TRUE(contains(result.err, words)) << result.err;
  }
  EXPECT_TRUE(contains(hamgen({"run", model, "--columns", "q"}).err, "add --plot FILE.svg"));
  EXPECT_TRUE(contains(hamgen({"run", model, "--plot", "x.pdf"}).err, "ends in .svg or .png"));
}

}  // namespace
}  // namespace hamgen::app_test
