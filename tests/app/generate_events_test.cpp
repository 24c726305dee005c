// hamgen generate --events: what the header finds is what `hamgen run --events` finds.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "runtime/process.hpp"
#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

constexpr const char* kEllipse =
    "system ellipse\ncoordinate x, y\nmomentum px, py\nparameter near = 1/2\n"
    "H = (px^2 + py^2)/2 - 1/sqrt(x^2 + y^2)\n"
    "event turn = x*px + y*py rising\nevent close = x^2 + y^2 - near^2\n"
    "event side = y falling\nevent never = 1 + x^2\n"
    "scene s { x = 2/5; py = 2; h = 1/10; steps = 2000 }\n";

// Writes rows as those of `run --events`, and for each event how often it was met.
constexpr const char* kFinder = R"(
#include <cstdio>
#include "ellipse.hpp"
int main() {
  using namespace ellipse::gauss_6;
  ellipse::State start;
  start.x = 0.4;
  start.py = 2;
  WatchedPropagator watched(Propagator({}, 0.1, start));
  const auto report = watched.advance(2000, [](const Crossing& c) {
    const char* names[] = {"turn", "close", "side", "never"};
    std::printf("%s %.17g %.17g %.17g %.17g %.17g\n", names[static_cast<int>(c.event)], c.time,
                c.state.x, c.state.y, c.state.px, c.state.py);
    return false;
  });
  return report.converged ? 0 : 1;
}
)";

struct EventRow {
  std::string event;
  double t = 0, values[4] = {};
};

std::vector<EventRow> rows_of_run(const std::string& csv) {
  std::vector<EventRow> rows;
  for (std::string line : lines(csv)) {
    if (line.empty() || line.front() == '#' || line.starts_with("event,")) continue;
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream words(line);
    EventRow row;
    std::string skipped;
    words >> row.event >> row.t >> skipped >> skipped;
    for (double& value : row.values) words >> value;
    rows.push_back(row);
  }
  return rows;
}

// To rounding, not to the bit: part of a step begins at the state, which in a run still has what
// rounding took from it.  A crossing's time is then off by what rounding takes of a state of about
// 1, 2^-52, over the rate of the event's value there, above 1/20 for all of these; 2000 steps apart
// none is more, as the steps are the same.
TEST(GenerateEvents, FindsWhatARunFinds) {
  const Scratch scratch;
  const std::string model = scratch.write("ellipse.ham", kEllipse);
  const Result run = hamgen({"run", model, "--scheme", "gauss-6", "--portable", "--quiet",
                             "--events", scratch.path("events.csv")});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::vector<EventRow> expected = rows_of_run(read(scratch.path("events.csv")));
  const Result generate =
      hamgen({"generate", model, "--scheme", "gauss-6", "--events", "-o", scratch.path("")});
  ASSERT_EQ(generate.status, 0) << generate.err;
  scratch.write("main.cpp", kFinder);
  const std::string program = scratch.path("finder");
  const auto compiled =
      runtime::run_process({.command = {"g++", "-std=c++17", "-O1", "-ffp-contract=off", "-I",
                                        scratch.path(""), scratch.path("main.cpp"), "-o", program},
                            .working_directory = {}});
  ASSERT_TRUE(compiled.succeeded()) << compiled.output;
  const auto found = runtime::run_process({.command = {program}, .working_directory = {}});
  ASSERT_TRUE(found.succeeded()) << found.output;
  std::istringstream output(found.output);
  std::size_t count = 0;
  for (EventRow row; output >> row.event >> row.t >> row.values[0] >> row.values[1] >>
                     row.values[2] >> row.values[3];
       ++count) {
    ASSERT_LT(count, expected.size());
    EXPECT_EQ(row.event, expected[count].event);
    const double rounding = 0x1p-52 * (64 + row.t);
    EXPECT_NEAR(row.t, expected[count].t, rounding);
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(row.values[i], expected[count].values[i], 8 * rounding) << row.event << i;
  }
  EXPECT_EQ(count, expected.size());
  EXPECT_GT(count, 120U);  // four a turn, 2 pi each
  // What was written is proved to be the model's, and is up to date; another value is not.
  const Result verified =
      hamgen({"verify", model, "--scheme", "gauss-6", "--emitted", scratch.path("ellipse.hpp")});
  EXPECT_EQ(verified.status, 0) << verified.out << verified.err;
  scratch.write("ellipse.ham",
                std::string(kEllipse).replace(std::string(kEllipse).find("1 + x^2"), 7, "2 + x^2"));
  const Result other =
      hamgen({"verify", model, "--scheme", "gauss-6", "--emitted", scratch.path("ellipse.hpp")});
  EXPECT_EQ(other.status, 5);
  const Result check = hamgen(
      {"generate", model, "--scheme", "gauss-6", "--events", "-o", scratch.path(""), "--check"});
  EXPECT_EQ(check.status, 1);
  EXPECT_TRUE(contains(check.err, "the code is another")) << check.err;
}

TEST(GenerateEvents, SaysWhereTheyAreNot) {
  const Scratch scratch;
  const std::string model = scratch.write("ellipse.ham", kEllipse);
  for (const char* format : {"c-header", "cpp-plugin"}) {
    const Result result = hamgen({"generate", model, "--events", "--format", format});
    EXPECT_EQ(result.status, 2);
    EXPECT_TRUE(contains(result.err, "help: a cpp-header has them")) << result.err;
  }
  const std::string none = scratch.write("none.ham", "coordinate q\nmomentum p\nH = p^2 + q^2\n");
  const Result result = hamgen({"generate", none, "--events"});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "event crossing = q rising")) << result.err;
}

}  // namespace
}  // namespace hamgen::app_test
