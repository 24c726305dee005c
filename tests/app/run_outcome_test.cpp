// How runs end.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"
#include "tests/app/run_results.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

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

// Of four equations solved together, as of one.
TEST(Run, LeavesTheDomainInAMatrixToo) {
  const Scratch scratch;
  const std::string model =
      scratch.write("m.ham",
                    "coordinate a, b, c, d\nmomentum u, v, w, x\n"
                    "H = (u^2 + v^2 + w^2 + x^2)/2 + b^2*c^2*d^2 + a^2*c^2 + sqrt(1 - a^2)*b\n"
                    "scene s { a = 0.9; b = 0.1; c = 0.2; d = 0.3; u = 2; h = 0.2; steps = 10 }\n");
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{}, {"--interpret"}, {"--scheme", "yoshida-4"}}) {
    std::vector<std::string> arguments = {model};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run_json(arguments, 1)["status"], "left the domain");
  }
}

// 1 - h^2/4 = 0: the step of the inverted spring has no solution at h = 2.
TEST(Run, SaysThatEquationsHaveNoSolution) {
  const Scratch scratch;
  const std::string one = scratch.write(
      "one.ham",
      "coordinate q\nmomentum p\nH = p^2/2 - q^2/2\nscene s { q = 1; h = 2; steps = 5 }\n");
  const std::string many = scratch.write(
      "many.ham",
      "size N = 40\ncoordinate q[1..N]\nmomentum p[1..N]\nH = sum(i = 1..N, p[i]^2/2 - q[i]^2/2)\n"
      "scene s { q[i] = i; h = 2; steps = 5 }\n");
  for (const std::string& model : {one, many}) {
    const json report = run_json({model}, 1);
    EXPECT_EQ(report["status"], "overflow") << report;
    EXPECT_TRUE(contains(report["reason"].get<std::string>(), "no solution at this h")) << report;
    EXPECT_EQ(report["steps_done"], 0);
  }
}

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

}  // namespace
}  // namespace hamgen::app_test
