#include "generator/language/scene.hpp"

#include <gtest/gtest.h>

#include <string>

#include "generator/language/read_model.hpp"

namespace hamgen {
namespace {

const Model& model() {
  static const Model read = read_model(make_source("x.ham",
                                                   "size N = 3\n"
                                                   "coordinate q[1..N]\n"
                                                   "momentum p[1..N]\n"
                                                   "parameter e = 1/4\n"
                                                   "parameter k[1..2] = [e, 2*e]\n"
                                                   "H = sum(i = 1..N, p[i]^2 + k[1]*q[i]^2)\n"
                                                   "scene first {\n"
                                                   "  q = [1, e, k[2]]\n"
                                                   "  q[2] = 7\n"
                                                   "  p[i] = i/2\n"
                                                   "  h = 0.1\n"
                                                   "  steps = 10\n"
                                                   "}\n"
                                                   "scene second { e = 1/2; q = e }\n"));
  return read;
}

std::string scene_refusal(const SceneRequest& request) {
  try {
    static_cast<void>(scene_values(model(), request));
    return "accepted";
  } catch (const UsageError& error) {
    return error.what();
  }
}

using Numbers = std::vector<Rational>;

// Only the scene that runs must fit sizes other than the file's.
TEST(Scene, may_be_for_other_sizes_as_long_as_another_one_runs) {
  const SourceText source = make_source("x.ham",
                                        "size N = 4\n"
                                        "coordinate q[1..N]\n"
                                        "momentum p[1..N]\n"
                                        "H = sum(i = 1..N, p[i]^2 + q[i]^2)\n"
                                        "scene any { q[i] = i; h = 1 }\n"
                                        "scene even { q[N/2] = 1; h = 1 }\n");
  const Model five = read_model(source, {{"N", 5}});
  EXPECT_EQ(scene_values(five, {}).q, (Numbers{1, 2, 3, 4, 5}));
  EXPECT_THROW(static_cast<void>(scene_values(five, {.scene = "even"})), ModelError);
  EXPECT_EQ(scene_values(read_model(source, {{"N", 6}}), {.scene = "even"}).q,
            (Numbers{0, 0, 1, 0, 0, 0}));
}

// Where a wave is zero a scene says so.
TEST(Scene, has_the_zeros_of_a_wave) {
  const Model ring = read_model(make_source("x.ham",
                                            "size N = 4\n"
                                            "coordinate q[1..N]\n"
                                            "momentum p[1..N]\n"
                                            "H = sum(i = 1..N, p[i]^2 + q[i]^2)\n"
                                            "scene wave {\n"
                                            "  q[i] = sin(2*pi*i/N)\n"
                                            "  p[i] = cos(2*pi*i/N)\n"
                                            "  h = 1\n"
                                            "}\n"));
  EXPECT_EQ(scene_values(ring, {}).q, (Numbers{1, 0, -1, 0}));
  EXPECT_EQ(scene_values(ring, {}).p, (Numbers{0, -1, 0, 1}));
}

TEST(Scene, the_first_one_is_the_default) {
  const SceneValues values = scene_values(model(), {});
  EXPECT_EQ(values.name, "first");
  EXPECT_EQ(values.parameters, (Numbers{Rational(1, 4), Rational(1, 4), Rational(1, 2)}));
  EXPECT_EQ(values.q, (Numbers{1, 7, Rational(1, 2)}));
  EXPECT_EQ(values.p, (Numbers{Rational(1, 2), 1, Rational(3, 2)}));
  EXPECT_EQ(values.h, Rational(1, 10));
  EXPECT_EQ(values.steps, 10);
  EXPECT_FALSE(values.every);
}

TEST(Scene, defaults_follow_the_parameters_a_scene_sets) {
  const SceneValues values = scene_values(model(), {.scene = "second"});
  EXPECT_EQ(values.parameters, (Numbers{Rational(1, 2), Rational(1, 2), 1}));
  EXPECT_EQ(values.q, (Numbers{Rational(1, 2), Rational(1, 2), Rational(1, 2)}));
  EXPECT_EQ(values.p, (Numbers{0, 0, 0}));
}

TEST(Scene, options_of_the_command_line_win) {
  const SceneValues values = scene_values(model(), {.scene = "first",
                                                    .set = {{"e", "2^2"}, {"k[1]", "9"}},
                                                    .initial = {{"q[1]", "e"}, {"p", "[1,2,3]"}},
                                                    .h = "-e/8",
                                                    .steps = "1e6"});
  EXPECT_EQ(values.parameters, (Numbers{4, 9, 8}));
  EXPECT_EQ(values.q, (Numbers{4, 7, 8}));
  EXPECT_EQ(values.p, (Numbers{1, 2, 3}));
  EXPECT_EQ(values.h, Rational(-1, 2));
  EXPECT_EQ(values.steps, 1000000);
}

TEST(Scene, a_time_is_as_many_steps_as_it_has_room_for) {
  const auto steps = [](const std::string& time, const std::string& h) {
    return scene_values(model(), {.scene = "first", .h = h, .time = time}).steps;
  };
  EXPECT_EQ(steps("1", "1/10"), 10);
  EXPECT_EQ(steps("1", "3/10"), 3);
  EXPECT_EQ(steps("-1", "-0.3"), 3);
  EXPECT_EQ(steps("e*10", "e/2"), 20);
  EXPECT_EQ(steps("0", "1"), 0);
  EXPECT_EQ(scene_values(model(), {.scene = "first", .time = "1"}).steps, 10);
  EXPECT_EQ(scene_refusal({.steps = "3", .time = "1"}),
            "--time 1 and --steps 3 both say how long\nhelp: drop one");
  EXPECT_EQ(scene_refusal({.time = "-1"}), "--time -1 and h = 0.1 go in opposite directions");
  EXPECT_EQ(scene_refusal({.time = "1e20"}), "--time 1e20: more than 1e15 steps of h = 0.1");
}

TEST(Scene, wrong_options_are_refused_by_name) {
  EXPECT_EQ(scene_refusal({.scene = "frist"}), "x has no scene 'frist': did you mean 'first'?");
  EXPECT_EQ(scene_refusal({.set = {{"e", "nan"}}}), "--set e=nan: not a finite number");
  EXPECT_EQ(scene_refusal({.initial = {{"q[1]", "-inf"}}}),
            "--initial q[1]=-inf: not a finite number");
  EXPECT_EQ(scene_refusal({.set = {{"q", "1"}}}),
            "--set q=1: 'q' is a coordinate; set it with --initial");
  EXPECT_EQ(scene_refusal({.set = {{"ee", "1"}}}),
            "--set:1:1: error: unknown name 'ee'\n"
            "  1 | ee=1\n"
            "    | ^~\n"
            "help: did you mean 'e', the parameter declared on line 4?\n");
  EXPECT_EQ(scene_refusal({.initial = {{"q", "[1, 2]"}}}),
            "--initial:1:1: error: 'q' has 3 elements, but 2 values are given\n"
            "  1 | q=[1, 2]\n"
            "    | ^~~~~~~~\n"
            "help: give one value for each of q[1..3]\n");
  EXPECT_EQ(scene_refusal({.set = {{"e", "1/(2-2)"}}}),
            "--set:1:3: error: division by zero\n"
            "  1 | e=1/(2-2)\n"
            "    |   ^~~~~~~\n"
            "help: the divisor is 0\n");
}

TEST(Scene, a_run_needs_a_step_and_a_number_of_steps_that_make_sense) {
  EXPECT_EQ(scene_refusal({.h = "0"}), "--h 0: the step size h must not be 0");
  EXPECT_EQ(scene_refusal({.h = "nan"}), "--h nan: not a finite number");
  EXPECT_EQ(scene_refusal({.steps = "-1"}),
            "--steps -1: the number of steps must be an integer between 0 and 1e15, not -1");
  EXPECT_EQ(scene_refusal({.steps = "1e30"}),
            "--steps 1e30: the number of steps must be an integer between 0 and 1e15, not 1e+30");
}

}  // namespace
}  // namespace hamgen
