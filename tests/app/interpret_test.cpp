// hamgen run --interpret: the steps of the compiled integrator, without a compiler.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"
#include "tests/app/run_results.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

// Members written out and in loops, stages, and a scalar that crosses the interface in two parts.
TEST(Interpret, TakesTheSameStepsWithoutACompiler) {
  const std::string models = std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/";
  const std::vector<std::vector<std::string>> runs = {
      {models + "harmonic.ham"},
      {models + "kepler.ham"},
      {models + "fput.ham"},
      {models + "kepler.ham", "--scheme", "gauss-6"},
      {models + "kepler.ham", "--scalar", "quad"}};
  for (std::vector<std::string> arguments : runs) {
    arguments.insert(arguments.end(), {"--steps", "200"});
    json compiled = run_json(arguments);
    arguments.emplace_back("--interpret");
    json interpreted = run_json(arguments);
    EXPECT_TRUE(interpreted.at("time").at("interpreted").get<bool>());
    EXPECT_FALSE(compiled.at("time").at("interpreted").get<bool>());
    for (json* result : {&compiled, &interpreted}) result->erase("time");
    EXPECT_EQ(interpreted, compiled) << arguments.front();
  }
}

// An unknown that is near zero for a moment is not told from what does not converge, if nothing
// knows what differences leave in so few digits.
TEST(Interpret, ASolvedStepOfFloatsIsNoFailure) {
  const Scratch scratch;
  const std::string model = scratch.write(
      "quartic.ham",
      "coordinate q\nmomentum p\nH = p^2/2 + q^2/2 + q^4/4\nscene s { q = 1; h = 0.1 }\n");
  const Result result = hamgen({"run", model, "--scheme", "gauss-4", "--solver", "newton",
                                "--scalar", "float", "--interpret", "--steps", "2000"});
  EXPECT_EQ(result.status, 0) << result.err;
}

TEST(Interpret, IsProposedWhereThereIsNoCompiler) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result none = hamgen({"run", model}, {"PATH=" + scratch.path("nothing"), "CXX="});
  EXPECT_EQ(none.status, 4) << none.err;
  EXPECT_TRUE(contains(none.err, "--interpret")) << none.err;
  const Result result =
      hamgen({"run", model, "--interpret"}, {"PATH=" + scratch.path("nothing"), "CXX="});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "interpreted, run")) << result.err;
  EXPECT_EQ(hamgen({"run", model, "--interpret", "--compiler", "g++"}).status, 2);
  const std::string large = std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/fput.ham";
  const Result too_large = hamgen({"run", large, "--set", "N=300", "--interpret"});
  EXPECT_EQ(too_large.status, 2) << too_large.err;
  EXPECT_TRUE(contains(too_large.err, "leave out --interpret")) << too_large.err;
  EXPECT_EQ(hamgen({"run", model, "--interpret", "--watch-modified", "2"}).status, 2);
}

}  // namespace
}  // namespace hamgen::app_test
