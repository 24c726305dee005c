// hamgen certify and hamgen run --certify: exit status, text and JSON.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

const std::string models = std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/";

Result certify(const std::string& model, std::vector<std::string> options) {
  options.insert(options.begin(), {"certify", model, "--interpret", "--quiet"});
  return hamgen(options);
}

TEST(CertifyCommand, SaysWhatIsProvedAndOfWhichSteps) {
  const Result result = certify(models + "kepler.ham", {"--steps", "40", "--every", "10"});
  EXPECT_EQ(result.status, 0) << result.err;
  const std::vector<std::string> text = lines(result.out);
  ASSERT_EQ(text.size(), 5u) << result.out;
  EXPECT_EQ(text[0], "kepler, scene e06: implicit-midpoint, h = 0.01");
  EXPECT_TRUE(text[1].starts_with("  certified   each of 4 steps looked at lies within "))
      << text[1];
  EXPECT_TRUE(text[1].ends_with(" of rounding of an exactly symplectic map")) << text[1];
  EXPECT_EQ(text[2], "  looked at   steps 1, 11, 21, ... of 40");
  EXPECT_TRUE(text[4].starts_with("  unique ")) << text[4];
}

// Momenta of 1e29 beside coordinates of 1e11: Sun, Earth and Moon.
TEST(CertifyCommand, KnowsTheUnitsOfCoordinatesAndMomenta) {
  const Scratch scratch;
  const std::string model = scratch.write(
      "m.ham",
      "coordinate x[1..3], y[1..3]\nmomentum px[1..3], py[1..3]\n"
      "parameter m[1..3] = [1.98892e30, 5.9722e24, 7.342e22]\nparameter G = 6.6743e-11\n"
      "H = sum(i=1..3, (px[i]^2 + py[i]^2)/(2*m[i])) - sum(i=1..3, j=i+1..3, "
      "G*m[i]*m[j]/sqrt((x[i]-x[j])^2 + (y[i]-y[j])^2))\n"
      "scene s { x = [0, 1.496e11, 1.499844e11]; py = [-1.801e29, 1.7785e29, 2.261e27]; h = 3600; "
      "steps = 20 }\n");
  for (const char* scheme : {"implicit-midpoint", "gauss-8"}) {
    const json found = json::parse(certify(model, {"--scheme", scheme, "--json"}).out);
    EXPECT_EQ(found["certified"], 20) << scheme;
    EXPECT_EQ(found["failed"], 0) << scheme;
  }
}

TEST(CertifyCommand, TellsTheFiguresAsJson) {
  const json found = json::parse(
      certify(models + "kepler.ham", {"--steps", "12", "--scheme", "rk4", "--json"}).out);
  EXPECT_FALSE(found["symplectic"].get<bool>());
  EXPECT_TRUE(found["holds"].get<bool>());
  EXPECT_EQ(found["certified"], 12);
  EXPECT_EQ(found["failed"], 0);
  EXPECT_EQ(found["ended"], "done");
  EXPECT_GT(found["units"].get<double>(), 0.0);
  // Four stages, each with the rounding of its state and its slope: a few units.
  EXPECT_LT(found["units"].get<double>(), 10.0);
  EXPECT_TRUE(found["uniqueness_radius"].is_null());
}

TEST(CertifyCommand, FailsWhereAStepIsFartherThanItMayBe) {
  const std::vector<std::string> steps = {"--steps", "5", "--within"};
  const auto within = [&](const std::string& units) {
    std::vector<std::string> options = steps;
    options.push_back(units);
    return certify(models + "kepler.ham", options);
  };
  EXPECT_EQ(within("100").status, 0);
  const Result near = within("1e-9");
  EXPECT_EQ(near.status, 1);
  EXPECT_TRUE(contains(near.err, "is farther than --within 1e-9")) << near.err;
  EXPECT_EQ(within("0").status, 2);
}

// Where a unit of rounding is no number, no distance is so many of them.
TEST(CertifyCommand, FailsWhereUnitsVanish) {
  const Scratch scratch;
  const std::string model =
      scratch.write("small.ham",
                    "coordinate q\nmomentum p\nH = p^2/2 + q^2/2\n"
                    "scene s { q = 1e-310; p = -3e-311; h = 0.1; steps = 5 }\n"
                    "scene t { q = 1e-200; p = -3e-201; h = 0.1; steps = 5 }\n");
  const Result result = certify(model, {});
  EXPECT_EQ(result.status, 1);
  EXPECT_TRUE(contains(result.out, "too small for a unit of rounding")) << result.out;
  EXPECT_EQ(certify(model, {"--scene", "t"}).status, 0);
}

TEST(CertifyCommand, FailsWhereTheRunEnds) {
  const Scratch scratch;
  const std::string model =
      scratch.write("edge.ham",
                    "system edge\ncoordinate q\nmomentum p\nH = p^2/2 + sqrt(q)\n"
                    "scene s {\n  q = 1\n  p = -1\n  h = 0.1\n  steps = 100\n}\n");
  const Result result = certify(model, {"--scheme", "stormer-verlet"});
  EXPECT_EQ(result.status, 1);
  EXPECT_TRUE(contains(result.out, "  ended       left the domain after ")) << result.out;
}

TEST(CertifyCommand, RefusesWithTheReason) {
  const Result sweeps = certify(models + "pendulum.ham", {"--solver", "sweeps:3"});
  EXPECT_EQ(sweeps.status, 2);
  EXPECT_TRUE(contains(sweeps.err, "leaves the step unsolved")) << sweeps.err;
  const Result raised = certify(models + "pendulum.ham", {"--order", "4"});
  EXPECT_EQ(raised.status, 2);
  EXPECT_TRUE(contains(raised.err, "a function K derived from H")) << raised.err;
  const Result large = certify(models + "fput.ham", {"--set", "N=300"});
  EXPECT_EQ(large.status, 2);
  EXPECT_TRUE(contains(large.err, "600 unknowns")) << large.err;
  const Result run = hamgen({"run", models + "pendulum.ham", "--certify", "--order", "4"});
  EXPECT_EQ(run.status, 2);
  EXPECT_TRUE(contains(run.err, "a function K derived from H")) << run.err;
}

// The step that was specialised against the exact map of all that the model has.
TEST(CertifyCommand, OfASceneThatNeedsLess) {
  for (const auto& [model, scene] :
       {std::pair{"oblate_kepler.ham", "equatorial"}, std::pair{"two_bodies.ham", "mirror"},
        std::pair{"two_bodies.ham", "apart"}, std::pair{"beads.ham", "second_mode"}}) {
    const Result result =
        certify(models + model, {"--scene", scene, "--steps", "20", "--interpret", "--json"});
    EXPECT_EQ(result.status, 0) << scene << result.err << result.out;
    const json found = json::parse(result.out);
    EXPECT_EQ(found["certified"], 20) << scene;
    EXPECT_TRUE(found["holds"].get<bool>()) << scene;
  }
}

// The compiled integrator this time.
TEST(CertifyCommand, ARunSaysItWithItsResult) {
  const Result result =
      hamgen({"run", models + "kepler.ham", "--steps", "30", "--certify", "--json"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "  certified   each of 30 steps lies within ")) << result.err;
  const json found = json::parse(result.out)["certified"];
  EXPECT_EQ(found["certified"], 30);
  EXPECT_TRUE(found["holds"].get<bool>());
  EXPECT_FALSE(json::parse(hamgen({"run", models + "kepler.ham", "--steps", "30", "--json"}).out)
                   .contains("certified"));
}

}  // namespace
}  // namespace hamgen::app_test
