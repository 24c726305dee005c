// hamgen::load: the command in a process of its own, as a program sees it.
#include "runtime/load.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "runtime/facts.hpp"
#include "runtime/tool_error.hpp"
#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

constexpr const char* kTwo =
    "system two\nsize N = 2\ncoordinate q[1..N]\nmomentum p[1..N]\nparameter k = 1/3\n"
    "parameter w[1..N] = [1, 2]\nlet s = sum(i = 1..N, q[i])\n"
    "H = sum(i = 1..N, p[i]^2/2 + w[i]^2*q[i]^2/2)\ninvariant first = (p[1]^2 + w[1]^2*q[1]^2)/2\n"
    "event middle = s + k - 1/3 falling\n"
    "scene one { q[1] = 1; h = 0.05; steps = 40 }\nscene other { p = 1; k = 0 }\n";

LoadOptions with(std::vector<std::string> method) {
  return {.method = std::move(method), .command = HAMGEN_EXECUTABLE};
}

TEST(Load, GivesNamesScenesAndOrbits) {
  const Scratch scratch;
  const System two = load(scratch.write("two.ham", kTwo), with({"--scheme", "gauss-4"}));
  EXPECT_EQ(two.name(), "two");
  EXPECT_EQ(two.scheme(), "gauss-4");
  EXPECT_EQ(two.order(), 4);
  EXPECT_EQ(two.coordinates(), (std::vector<std::string>{"q[1]", "q[2]"}));
  EXPECT_EQ(two.momenta(), (std::vector<std::string>{"p[1]", "p[2]"}));
  EXPECT_EQ(two.parameters(), (std::vector<std::string>{"k", "w[1]", "w[2]"}));
  EXPECT_EQ(two.invariants(), std::vector<std::string>{"first"});
  EXPECT_EQ(two.events(), std::vector<std::string>{"middle"});
  EXPECT_EQ(two.scenes(), (std::vector<std::string>{"one", "other"}));
  Start start = two.start();
  EXPECT_EQ(start.value("w[2]"), 2);
  EXPECT_EQ(start.value("k"), 1.0 / 3.0);
  EXPECT_EQ(two.start("other").value("p[1]"), 1);
  EXPECT_EQ(two.start("other").value("k"), 0);
  EXPECT_EQ(start.steps(), 40);
  EXPECT_FALSE(two.start("other").steps());

  double first = 0.0;
  RunOptions options{.steps = 40, .every = 10};
  long long records = 0;
  options.on_record = [&records](const auto&) { ++records; };
  options.events = {two.event("middle", start, [&first](const auto& point) {
    first = point.time;
    return true;
  })};
  const Trajectory half = two.run(start, options);  // cos(t) = 0
  ASSERT_TRUE(half.ended_by);
  EXPECT_NEAR(first, std::numbers::pi / 2, 1e-7);
  EXPECT_EQ(half.time, first);
  EXPECT_EQ(records, 4);
  EXPECT_EQ(half.summary.steps_done, 32);
  EXPECT_NEAR(two.invariant("first", start, half.state), 0.5, 1e-12);
  // The event follows the parameters of its start, and a program may have its own.
  start.set("k", 0);  // cos(t) = 1/3
  options.events = {two.event("middle", start, [](const auto&) { return true; })};
  EXPECT_NEAR(two.run(start, options).time, std::acos(1.0 / 3.0), 1e-7);
  options.events = {{.quantity = [](auto state) { return state[0].hi - 0.5; },
                     .direction = runtime::Direction::both,
                     .on_event = [](const auto&) { return true; }}};
  EXPECT_NEAR(two.run(start, options).time, std::numbers::pi / 3, 1e-7);
}

TEST(Load, SaysWhatTheCommandSays) {
  const Scratch scratch;
  const std::string wrong =
      scratch.write("wrong.ham", "coordinate q\nmomentum p\nH = p^2/2 + cos(r)\n");
  try {
    (void)load(wrong, with({}));
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_EQ(error.kind(), LoadError::Kind::model);
    EXPECT_EQ(error.what(), hamgen({"check", wrong}).err);
    EXPECT_TRUE(contains(error.what(), "wrong.ham:3:17: error: unknown name 'r'"));
  }
  try {
    (void)load(scratch.write("two.ham", kTwo), with({"--scheme", "gauss-5"}));
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_EQ(error.kind(), LoadError::Kind::usage);
    EXPECT_TRUE(contains(error.what(), "gauss-5")) << error.what();
  }
  EXPECT_THROW((void)load(scratch.path("none.ham"), with({})), LoadError);
  EXPECT_THROW((void)load(wrong, {.command = scratch.path("no-hamgen")}), runtime::ToolError);
  EXPECT_THROW((void)load(wrong, {.command = "/bin/false"}), runtime::ToolError);
}

TEST(Load, RefusesNamesThatAreNotThere) {
  const Scratch scratch;
  const System two = load(scratch.write("two.ham", kTwo), with({"--scheme", "gauss-4"}));
  Start start = two.start();
  EXPECT_THROW(start.set("q", 1), std::out_of_range);
  EXPECT_THROW((void)start.value("q[3]"), std::out_of_range);
  EXPECT_THROW((void)two.start("third"), std::out_of_range);
  EXPECT_THROW((void)two.event("end", start, {}), std::out_of_range);
  EXPECT_THROW((void)two.start("other").values(), std::invalid_argument);  // no h
  EXPECT_THROW((void)two.run(start.set("q[1]", std::nan("")), {.steps = 1}), std::invalid_argument);
}

TEST(Load, IsDocumentedByTheExampleThatRuns) {
  EXPECT_TRUE(contains(read(HAMGEN_SOURCE_DIR "/docs/runtime.md"),
                       read(HAMGEN_SOURCE_DIR "/tests/consumer/load/orbit.cpp")));
}

TEST(Facts, ReadBackToTheSame) {
  SystemFacts facts{.name = "a", .scheme = "alpha = 1/2, beta = 0.1*h", .order = 2};
  facts.coordinates = {"q[1]"};
  facts.momenta = {"p[1]"};
  facts.parameters = {"m"};
  facts.invariants = {"L"};
  facts.event_names = {"hit"};
  facts.events = {{1, runtime::Direction::falling}};
  facts.scene_names = {"s"};
  facts.scenes = {{.parameters = {{0.1, 1e-18}},
                   .state = {{1, 0}, {-2.5e-300, 0}},
                   .h = runtime::Wide{0.3, 0},
                   .steps = 7}};
  const std::string text = to_text(facts);
  EXPECT_EQ(to_text(read_facts(text)), text);
  EXPECT_EQ(read_facts(text).scenes[0].parameters[0].lo, 1e-18);
  for (const std::string& broken :
       {std::string(), text.substr(0, text.size() - 4), "hamgen-facts 2" + text.substr(14),
        text.substr(0, text.size() - 4) + "surprise 1\nend\n"})
    EXPECT_THROW((void)read_facts(broken), runtime::ToolError) << broken;
}

}  // namespace
}  // namespace hamgen::app_test
