#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "runtime/process.hpp"
#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

json run_json(std::vector<std::string> arguments, int status = 0) {
  arguments.insert(arguments.begin(), "run");
  arguments.insert(arguments.end(), {"--json", "--quiet"});
  const Result result = hamgen(arguments);
  EXPECT_EQ(result.status, status) << result.err;
  return json::parse(result.out);
}

struct Csv {
  std::vector<std::string> metadata;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};

Csv read_csv(const std::string& text) {
  Csv csv;
  for (const std::string& line : lines(text)) {
    if (line.starts_with("#")) {
      csv.metadata.push_back(line);
      continue;
    }
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
    }
    if (csv.columns.empty()) {
      csv.columns = cells;
      continue;
    }
    csv.rows.emplace_back();
    for (const std::string& cell : cells)
      csv.rows.back().push_back(std::strtod(cell.c_str(), nullptr));
  }
  return csv;
}

TEST(Run, RefusesCompilersThatChangeTheArithmetic) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  for (const std::string flag : {"-ffast-math", "-Ofast", "-fassociative-math", "@flags"}) {
    const Result option = hamgen({"run", model, "--compiler", "g++ " + flag});
    EXPECT_EQ(option.status, 2) << option.err;
    EXPECT_TRUE(contains(option.err, "--compiler: ") && contains(option.err, "'" + flag + "'"))
        << option.err;
    for (const std::string command : {"run", "bench", "stress", "tune"}) {
      const Result variable = hamgen({command, model}, {"CXX=g++ " + flag});
      EXPECT_EQ(variable.status, 2) << command << variable.err;
      EXPECT_TRUE(contains(variable.err, "$CXX: ")) << variable.err;
    }
  }
}

TEST(Run, FindsACompilerOutThatChangesTheArithmeticByItself) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string script = scratch.write("compiler", "#!/bin/sh\nexec g++ \"$@\" -ffast-math\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  const Result result = hamgen({"run", model, "--compiler", script});
  EXPECT_EQ(result.status, 4);
  EXPECT_TRUE(contains(result.err, "compile without -ffast-math")) << result.err;
}

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
  EXPECT_EQ(refused.status, 3) << refused.err;
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

TEST(Run, StopsWhereTheStepFailsAndKeepsWhatItHas) {
  const Scratch scratch;
  const std::string model = scratch.write("collapse.ham", collapse);
  const std::string output = scratch.path("out.csv");
  const Result result = hamgen({"run", model, "--json", "-o", output});
  EXPECT_EQ(result.status, 1);
  EXPECT_TRUE(contains(result.err, "--h 0.0025")) << result.err;
  EXPECT_FALSE(contains(result.out, "nan"));
  const json report = json::parse(result.out);
  EXPECT_TRUE(report["status"] == "not converged" || report["status"] == "left the domain")
      << report["status"];
  EXPECT_TRUE(report["reason"].is_string());
  const long done = report["steps_done"].get<long>();
  // The exact solution ends at t = 0.7071, after 70 steps.
  EXPECT_GT(done, 60);
  EXPECT_LT(done, 1000);
  const Csv csv = read_csv(read(output));
  EXPECT_EQ(static_cast<long>(csv.rows.size()), done + 1);
  const std::string status = report["status"];
  EXPECT_TRUE(csv.metadata.back().starts_with("# status    " + status + ": step "))
      << csv.metadata.back();
}

struct Failure {
  std::string hamiltonian, scene;
  std::vector<std::string> options;
  std::string status;
};

// The state in the summary, the last row and the numbers of energy and steps are of one step, the
// last whose end has an energy.
TEST(Run, EndsEveryFailureWithItsNameAndTheLastGoodState) {
  const std::string collision = "p^2/2 - 1/abs(q)";
  const std::vector<Failure> failures = {
      {collision, "q = 1; p = 0; h = 0.01", {"--scheme", "stormer-verlet"}, "jumped"},
      {collision, "q = 1; p = 0; h = 0.01", {}, "not converged"},
      {"p^2/2 + tan(q)", "q = 1.5; p = 1; h = 0.01", {}, "jumped"},
      {"p^2/2 + log(q)", "q = 1; p = -1; h = 0.05", {}, "left the domain"},
      {"p^2/2 + log(q)", "q = 1; p = -1; h = 0.05", {"--scheme", "rk4"}, "left the domain"},
      {"p^2/2 + log(q)",
       "q = 1; p = -1; h = 0.05",
       {"--scheme", "stormer-verlet"},
       "left the domain"},
      {"p^2/2 + log(q)", "q = 1; p = -1; h = 0.05", {"--scalar", "quad"}, "left the domain"},
      {"p^2/2 + sqrt(q)", "q = 1; p = -1; h = 0.05", {"--scheme", "gauss-8"}, "left the domain"},
      {"p^2/2 + q^4", "q = 1e70; h = 1", {"--scheme", "stormer-verlet"}, "overflow"},
      {"p^2/2 - q^4", "q = 1; p = 1; h = 1e-5", {}, "escaped"},
      {"p^2/2 + q^2/2", "q = 1; h = 0.1", {"--scheme", "explicit-euler"}, "jumped"}};
  const Scratch scratch;
  for (const Failure& each : failures) {
    const std::string model =
        scratch.write("m.ham", "coordinate q\nmomentum p\nH = " + each.hamiltonian +
                                   "\nscene s { " + each.scene + "; steps = 100000 }\n");
    std::vector<std::string> arguments = {model, "-o", scratch.path("rows.csv")};
    arguments.insert(arguments.end(), each.options.begin(), each.options.end());
    const json report = run_json(arguments, 1);
    const std::string name = each.hamiltonian + " " + each.status;
    EXPECT_EQ(report["status"], each.status) << report;
    EXPECT_TRUE(report["reason"].get<std::string>().starts_with("step ")) << name;
    const Csv csv = read_csv(read(scratch.path("rows.csv")));
    const long done = report["steps_done"];
    ASSERT_EQ(static_cast<long>(csv.rows.size()), done + 1) << name;
    EXPECT_TRUE(contains(csv.metadata.back(),
                         "status    " + each.status + ": step " + std::to_string(done + 1) + " "))
        << csv.metadata.back();
    const std::vector<double>& row = csv.rows.back();
    EXPECT_EQ(row[0], done) << name;
    EXPECT_EQ(row[2], report["state"]["q"][0].get<double>()) << name;
    EXPECT_EQ(row[3], report["state"]["p"][0].get<double>()) << name;
    EXPECT_TRUE(std::isfinite(row[4])) << name;
    EXPECT_EQ(row[4] - report["energy"]["initial"].get<double>(),
              report["energy"]["final_error"].get<double>())
        << name;
    if (contains(each.hamiltonian, "log") || contains(each.hamiltonian, "sqrt")) {
      EXPECT_GT(row[2], 0.0) << name;
    }
  }
}

// Large errors that are none of these: runs with absurd steps, from a saddle, from rest.
TEST(Run, DoesNotTakeALargeErrorForAJump) {
  const Scratch scratch;
  const std::string model =
      scratch.write("m.ham",
                    "coordinate q\nmomentum p\ntime t\nH = p^2/2 - q^2/2 + q^4/4 - force*q*cos(t)\n"
                    "parameter force = 0\nscene saddle { q = 1e-9; h = 0.1; steps = 2000 }\n"
                    "scene rest { h = 0.1; steps = 2000 }\n");
  for (const std::string scheme : {"implicit-midpoint", "stormer-verlet"}) {
    EXPECT_EQ(run_json({model, "--scene", "saddle", "--scheme", scheme})["status"], "done");
    for (const std::string h : {"0.01", "0.1"})
      EXPECT_EQ(run_json({model, "--scene", "rest", "--set", "force=1", "--h", h, "--scheme",
                          scheme})["status"],
                "done")
          << h << scheme;
  }
  const std::string pendulum_model = std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/pendulum.ham";
  EXPECT_EQ(run_json({pendulum_model, "--h", "10", "--steps", "10000"})["status"], "done");
}

TEST(Run, SaysInTheTrajectoryThatItIsDone) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result result = hamgen({"run", model, "--steps", "5", "-o", "-"});
  EXPECT_EQ(lines(result.out).back(), "# status    done");
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

TEST(Run, NamesAMissingCompilerAndUsesNoShell) {
  const Scratch scratch;
  // A model of its own, so that the cache cannot help.
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result missing = hamgen({"run", model, "--compiler", "no-such-compiler"});
  EXPECT_EQ(missing.status, 4);
  EXPECT_TRUE(contains(missing.err, "no-such-compiler")) << missing.err;
  const Result shell = hamgen({"run", model}, {"CXX=g++; touch " + scratch.path("touched")});
  EXPECT_EQ(shell.status, 4);
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"pendulum.ham"}));
}

TEST(Run, GoesOnWithoutAUsableCache) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string file = scratch.write("file", "");
  const Result result = hamgen({"run", model, "--steps", "1"}, {"HAMGEN_CACHE=" + file});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "warning")) << result.err;
}

// A disk of its own for the cache, in a namespace of its own where the system has such.
Result run_with_cache_of(const std::string& size, const std::string& model,
                         const std::string& directory) {
  runtime::ProcessRequest request;
  request.command = {"unshare",
                     "-Urm",
                     "sh",
                     "-c",
                     "mount -t tmpfs -o mode=700,size=\"$1\" tmpfs \"$2\" || exit 99; "
                     "HAMGEN_CACHE=\"$2\" \"$3\" run \"$4\" --steps 10",
                     "sh",
                     size,
                     directory,
                     HAMGEN_EXECUTABLE,
                     model};
  const runtime::ProcessResult result = runtime::run_process(request);
  return {.status = result.code, .out = "", .err = result.output};
}

TEST(Run, GoesOnWithAFullOrNearlyFullCacheDisk) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string directory = scratch.path("disk");
  std::filesystem::create_directory(directory);
  if (run_with_cache_of("64m", model, directory).status != 0)
    GTEST_SKIP() << "no disk can be mounted here";
  int warnings = 0;
  for (const std::string size : {"4k", "20k", "24k", "32k", "40k", "48k", "64k", "128k"}) {
    const Result result = run_with_cache_of(size, model, directory);
    EXPECT_EQ(result.status, 0) << size << '\n' << result.err;
    warnings += contains(result.err, "warning: ") ? 1 : 0;
  }
  EXPECT_GE(warnings, 4);
}

TEST(Cache, ListsAndClears) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::vector<std::string> own = {"HAMGEN_CACHE=" + scratch.path("cache")};
  ASSERT_EQ(hamgen({"run", model, "--steps", "1"}, own).status, 0);
  const Result listed = hamgen({"cache"}, own);
  EXPECT_EQ(listed.status, 0);
  EXPECT_TRUE(contains(listed.out, "1 compiled integrator,")) << listed.out;
  EXPECT_EQ(hamgen({"cache", "prune"}, own).status, 0);
  EXPECT_EQ(hamgen({"cache", "clear"}, own).status, 0);
  EXPECT_TRUE(contains(hamgen({"cache", "list"}, own).out, "0 compiled integrators,"));
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
