// What a run is given, and what it hands out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"
#include "tests/app/run_results.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

TEST(Run, ShowsControlCharactersOfPathsInTextJsonAndCsv) {
  const Scratch scratch;
  const std::string name = "a\r\n\u202E#b\xFF.ham";
  const std::string model = scratch.write(name, pendulum);
  const Result result =
      hamgen({"run", model, "--json", "--steps", "10", "-o", scratch.path("rows.csv")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, R"(a\r\n\u202e#b)")) << result.out;
  EXPECT_TRUE(
      json::parse(result.out).at("path").get<std::string>().ends_with("a\r\n\u202E#b\uFFFD.ham"));
  const Csv csv = read_csv(read(scratch.path("rows.csv")));
  EXPECT_EQ(csv.rows.size(), 11u);
  EXPECT_TRUE(contains(csv.metadata.at(1), "a<U+000D><U+000A><U+202E>#b<0xFF>.ham"))
      << csv.metadata.at(1);
  EXPECT_FALSE(contains(result.err, "\r") || contains(result.err, "\u202E")) << result.err;
}

TEST(Run, TakesTheParametersOfTheSchemeAtRunTime) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const json fixed = run_json({model, "--alpha", "3/8", "--beta=-h/500", "--gamma=-h/16"});
  const json free =
      run_json({model, "--alpha", "alpha", "--beta", "beta*h", "--gamma", "gamma*h", "--set",
                "alpha=0.375", "--set", "beta=-0.002", "--set", "gamma=-1/16"});
  // The same member; its constants are rounded in another order, by 1e-16, which t = 100 near the
  // separatrix stretches by about 1e3.
  EXPECT_NEAR(free["state"]["q"][0].get<double>(), fixed["state"]["q"][0].get<double>(), 1e-11);
  const json unset = run_json({model, "--alpha", "alpha", "--beta", "beta*h"});
  EXPECT_NEAR(unset["state"]["q"][0].get<double>(),
              run_json({model})["state"]["q"][0].get<double>(), 1e-11);
  // A coordinate of that name is no parameter.
  const std::string other =
      scratch.write("other.ham", "system other\ncoordinate beta\nmomentum p\nH = p^2/2 + beta^4\n");
  const Result refused = hamgen(
      {"run", other, "--beta", "beta", "--initial", "beta=1,p=0", "--h", "0.1", "--steps", "10"});
  EXPECT_EQ(refused.status, 2) << refused.err;
}

TEST(Run, GivesTheResultAsJson) {
  const Scratch scratch;
  const json result = run_json({scratch.write("pendulum.ham", pendulum)});
  EXPECT_EQ(result["model"], "pendulum");
  EXPECT_EQ(result["scene"], "swing");
  EXPECT_EQ(result["scheme"], "implicit-midpoint");
  EXPECT_EQ(result["status"], "done");
  EXPECT_EQ(result["h"], 0.1);
  EXPECT_EQ(result["steps"], 1000);
  EXPECT_EQ(result["steps_done"], 1000);
  // H(0) = -0.03 cos(3.1).
  EXPECT_NEAR(result["energy"]["initial"].get<double>(), 0.03 * std::cos(M_PI - 3.1), 1e-16);
  // The reference of the shadowing literature for 1e5 steps is 1.4987e-6; 1000 steps see one pass.
  EXPECT_NEAR(result["energy"]["spread"].get<double>(), 1.4987e-6, 0.02e-6);
  // The midpoint rule at t = 100, whose error there is 2.37e-4.
  EXPECT_NEAR(result["state"]["q"][0].get<double>(), 2.29712982881406863, 4e-4);
  EXPECT_NEAR(result["state"]["p"][0].get<double>(), 0.141774928393845888, 4e-4);
  EXPECT_GT(result["solver"]["iterations_per_step"].get<double>(), 0.9);
  for (const char* key : {"generate_s", "compile_s", "run_s", "ns_per_step"})
    EXPECT_TRUE(result["time"][key].is_number()) << key;
}

TEST(Run, SumsUpOnStandardError) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result result = hamgen({"run", model});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out, "");
  for (const char* part : {"implicit-midpoint", "solver", "energy", "time", "ns/step", "header"})
    EXPECT_TRUE(contains(result.err, part)) << result.err;
  EXPECT_LE(lines(result.err).size(), 14u) << result.err;
  EXPECT_FALSE(contains(result.err, "\r"));
  EXPECT_FALSE(contains(result.err, "\x1b"));
}

TEST(Run, TakesParametersAtRunTimeWithoutCompiling) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  static_cast<void>(run_json({model}));
  const json second = run_json({model, "--set", "eps=3/50", "--initial", "q=0, p=1/10"});
  EXPECT_EQ(second["time"]["from_cache"], true);
  EXPECT_EQ(second["parameters"]["eps"], 0.06);
  EXPECT_NEAR(second["energy"]["initial"].get<double>(), 0.1 * 0.1 / 2 - 0.06, 1e-16);
}

TEST(Run, FoldsAParameterWithItsValue) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  for (const std::string value : {"eps=3/50", "eps=1/10"}) {
    const json folded = run_json({model, "--fold", "eps", "--set", value});
    EXPECT_EQ(folded["solver"]["left_out"][0].get<std::string>().substr(0, 13), "parameter eps");
    // One machine multiplication may round differently, a thousand steps apart by far less.
    EXPECT_NEAR(folded["state"]["q"][0].get<double>(),
                run_json({model, "--set", value})["state"]["q"][0].get<double>(), 1e-12);
  }
  const Result refused = hamgen({"run", model, "--whole", "--fold", "eps", "--set", "eps=1"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(contains(refused.err, "leave out --fold eps")) << refused.err;
}

TEST(Run, ComputesTheEnergyParameter) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const json result = run_json({model, "--beta=E0*h/10"});
  EXPECT_EQ(result["parameters"]["E0"], result["energy"]["initial"]);
  // The same member with the energy written as a number: beta = 0.0029974... h.
  const json plain =
      run_json({model, "--beta=" + std::to_string(0.0) + "+" +
                           json(result["energy"]["initial"].get<double>() / 10).dump() + "*h"});
  EXPECT_NEAR(result["state"]["q"][0].get<double>(), plain["state"]["q"][0].get<double>(), 1e-9);
}

TEST(Run, WritesATrajectory) {
  const Scratch scratch;
  const std::string model = scratch.write("two.ham", two_oscillators);
  const std::string output = scratch.path("out.csv");
  const json result = run_json({model, "--initial", "x=1,y=1/2", "--h", "1/8", "--steps", "100",
                                "--every", "10", "-o", output});
  const Csv csv = read_csv(read(output));
  EXPECT_EQ(csv.columns,
            (std::vector<std::string>{"step", "t", "x", "y", "px", "py", "H", "first"}));
  ASSERT_EQ(csv.rows.size(), 11u);
  EXPECT_EQ(csv.rows[0], (std::vector<double>{0, 0, 1, 0.5, 0, 0, 1, 0.5}));
  EXPECT_EQ(csv.rows[10][0], 100);
  EXPECT_EQ(csv.rows[10][1], 12.5);
  // The same doubles as in the result.
  EXPECT_EQ(csv.rows[10][2], result["state"]["q"][0].get<double>());
  EXPECT_EQ(csv.rows[10][5], result["state"]["p"][1].get<double>());
  EXPECT_NEAR(result["invariants"]["first"]["final_error"].get<double>(), 0.0, 1e-14);
  EXPECT_TRUE(
      std::ranges::any_of(csv.metadata, [](const auto& line) { return contains(line, "sha256"); }));
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"out.csv", "two.ham"}));
}

// What the scene defines to look at it is computed where nothing is left out, too.
TEST(Run, WritesTheFormulasOfAScene) {
  const std::string model = HAMGEN_SOURCE_DIR "/hamiltonians/two_bodies.ham";
  for (const std::vector<std::string>& options : {std::vector<std::string>{}, {"--whole"}}) {
    std::vector<std::string> words{"run", model, "--scene", "apart", "--steps", "3", "-o", "-"};
    words.insert(words.end(), options.begin(), options.end());
    const Result result = hamgen(words);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "step,t,distance\n")) << result.out;
  }
}

TEST(Run, DoesNotOverwriteTheModel) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result result = hamgen({"run", model, "-o", model});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "that is the model")) << result.err;
  EXPECT_EQ(read(model), pendulum);
}

// The clock of a run begins at 0, the variable t where its scene says.
TEST(Run, TellsTheVariableTFromTheClock) {
  const Scratch scratch;
  const std::string model = scratch.write("driven.ham",
                                          "coordinate q\nmomentum p\ntime t\n"
                                          "H = p^2/2 + (1 + cos(t)/5)*q^2/2\n"
                                          "scene late { t = 10; q = 1; h = 0.5; steps = 2 }\n");
  const Result result = hamgen({"run", model, "-o", "-", "--quiet"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Csv csv = read_csv(result.out);
  EXPECT_EQ(csv.columns,
            (std::vector<std::string>{"step", "elapsed", "q", "t", "p", "p_t", "H+p_t"}));
  ASSERT_EQ(csv.rows.size(), 3u);
  EXPECT_EQ(csv.rows[2][1], 1);
  EXPECT_EQ(csv.rows[2][3], 11);
}

// A parameter that gives initial values alone is in the records of the run, not in the code.
TEST(Run, NamesParametersThatTheStepDoesNotHave) {
  const Scratch scratch;
  const std::string model = scratch.write("launch.ham",
                                          "coordinate q\nmomentum p\nparameter v = 3\n"
                                          "H = p^2/2 + q^2/2\n"
                                          "scene launch { p = v; h = 0.5; steps = 2 }\n");
  const json result = run_json({model, "--set", "v=5"});
  EXPECT_EQ(result["parameters"]["v"], 5.0);
  // p at t = 1 of the midpoint rule: v cos(2 phi) with tan(phi/2) = h/2.
  EXPECT_NEAR(result["state"]["p"][0], 5 * std::cos(4 * std::atan(0.25)), 1e-14);
  const Result header = hamgen({"generate", model});
  EXPECT_FALSE(contains(header.out, "Real v")) << header.out;
  EXPECT_TRUE(contains(header.out, "parameters v: the step does not use them")) << header.out;
}

TEST(Run, StreamsTheTrajectoryToStandardOutput) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string output = scratch.path("out.csv");
  ASSERT_EQ(hamgen({"run", model, "--steps", "20", "-o", output}).status, 0);
  const Result streamed = hamgen({"run", model, "--steps", "20", "-o", "-"});
  EXPECT_EQ(streamed.status, 0);
  EXPECT_EQ(streamed.out, read(output));
  EXPECT_EQ(read_csv(streamed.out).rows.size(), 21u);
  const Result both = hamgen({"run", model, "-o", "-", "--json"});
  EXPECT_EQ(both.status, 2);
  EXPECT_TRUE(contains(both.err, "-o FILE.csv")) << both.err;
}

TEST(Run, AsksBeforeItFloodsTheDisk) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result result = hamgen({"run", model, "--steps", "1e9", "-o", scratch.path("x.csv")});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "--every 100000")) << result.err;
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"pendulum.ham"}));
}

TEST(Run, NeedsAnInitialStateStepsAndStepSize) {
  const Scratch scratch;
  const std::string model = scratch.write("two.ham", two_oscillators);
  const Result none = hamgen({"run", model});
  EXPECT_EQ(none.status, 2);
  EXPECT_TRUE(contains(none.err, "--initial x=0.1,px=0 --h 0.01 --steps 1000")) << none.err;
  const Result no_steps = hamgen({"run", model, "--initial", "x=1", "--h", "0.1"});
  EXPECT_EQ(no_steps.status, 2);
  EXPECT_TRUE(contains(no_steps.err, "--steps 1000")) << no_steps.err;
}

TEST(Run, RefusesValuesOutOfRange) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::vector<std::vector<std::string>> wrong = {
      {"--h", "0"},         {"--h", "nan"},         {"--h", "inf"},       {"--steps", "-1"},
      {"--steps", "1e30"},  {"--every", "0"},       {"--every", "0.5"},   {"--initial", "q=nan"},
      {"--initial", "x=1"}, {"--initial", "q=1,2"}, {"--initial", "q"},   {"--set", "epz=1"},
      {"--set", "eps=inf"}, {"--alpha", "nan"},     {"--scene", "swimg"}, {"--scalar", "half"},
      {"--solver", "magic"}};
  for (const std::vector<std::string>& options : wrong) {
    std::vector<std::string> arguments = {"run", model};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Result result = hamgen(arguments);
    EXPECT_TRUE(result.status == 2 || result.status == 3)
        << options[0] << ' ' << options[1] << ": " << result.status << '\n'
        << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err, "");
  }
}

TEST(Run, NamesTheComponentThatIsNotDefinedAtTheStart) {
  const Scratch scratch;
  const std::string model = scratch.write("collapse.ham", collapse);
  const Result result = hamgen({"run", model, "--initial", "q=0"});
  EXPECT_EQ(result.status, 3);
  EXPECT_TRUE(contains(result.err, "H is not defined at the initial state")) << result.err;
  EXPECT_TRUE(contains(result.err, "q = 0")) << result.err;
}

TEST(Run, RegeneratesForAnotherSize) {
  const Scratch scratch;
  const std::string model = scratch.write("chain.ham", chain);
  const json result = run_json({model, "--set", "N=12"});
  EXPECT_EQ(result["state"]["q"].size(), 12u);
}

TEST(Run, KeepsTheEmittedHeader) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string directory = scratch.path("kept");
  EXPECT_EQ(hamgen({"run", model, "--header", directory}).status, 0);
  EXPECT_EQ(read(directory + "/pendulum.hpp"), hamgen({"generate", model, "--scene", "swing"}).out);
}

// E0 = 1/200 exactly, and as a double only to 53 bits: 1e-19 of beta, and as much of the state.
TEST(Run, TakesTheInitialEnergyWithTheDigitsOfTheScalar) {
  const Scratch scratch;
  const std::string model =
      scratch.write("harmonic.ham",
                    "system harmonic\ncoordinate q\nmomentum p\nH = (p^2 + q^2)/2\n"
                    "scene s {\n  q = 0.1\n  h = 0.1\n  steps = 100\n}\n");
  const auto state = [&](const std::string& beta) {
    return run_json({model, "--beta", beta, "--scalar", "quad"})["state"];
  };
  const json energy = state("E0*h");
  const json number = state("h/200");
  EXPECT_NE(number, state("h/201"));
  for (const std::string part : {"q", "p"}) {
    EXPECT_EQ(energy[part], number[part]);
    // hi + lo has 106 bits, the state 113: 100 steps at their rounding, 2^-113 of 0.1, are 1e-33.
    EXPECT_NEAR(energy[part + "_lo"][0].get<double>(), number[part + "_lo"][0].get<double>(),
                1e-31);
  }
}

}  // namespace
}  // namespace hamgen::app_test
