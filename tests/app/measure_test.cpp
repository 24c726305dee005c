// hamgen verify --measure: the compiled step's own tangent map.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

struct Measured {
  std::string verdict;
  double most = -1;         // of M^T J M - J over the states
  std::string of_the_step;  // verdict on M against difference quotients
  std::string reversal;
  int status = -1;
};

Measured measured(const std::string& model, std::vector<std::string> options) {
  const bool is_shipped = model.find('/') == std::string::npos;
  options.insert(options.begin(),
                 {"verify", (is_shipped ? HAMGEN_SOURCE_DIR "/hamiltonians/" : "") + model,
                  "--measure", "--json"});
  const Result result = hamgen(options);
  Measured found{.status = result.status};
  for (const auto& finding : nlohmann::json::parse(result.out)) {
    if (finding["property"] == "tangent map of the step") found.of_the_step = finding["verdict"];
    if (finding["property"] == "reversal") found.reversal = finding["verdict"];
    if (finding["property"] != "tangent map symplectic") continue;
    found.verdict = finding["verdict"];
    const std::string detail = finding["detail"];
    found.most = std::strtod(detail.c_str() + detail.find("at most ") + 8, nullptr);
  }
  return found;
}

using ModelAndOptions = std::pair<std::string, std::vector<std::string>>;

void expect_symplectic(const std::vector<ModelAndOptions>& steps) {
  for (const auto& [model, options] : steps) {
    const Measured found = measured(model, options);
    EXPECT_EQ(found.verdict, "tested") << model;
    EXPECT_GE(found.most, 0) << model;
    EXPECT_LE(found.most, 1e-13) << model;
    EXPECT_EQ(found.of_the_step, "tested") << model;
    EXPECT_NE(found.reversal, "refuted") << model;
  }
}

TEST(Measure, FindsSymplecticStepsSymplecticToRoundOff) {
  expect_symplectic({{"pendulum.ham", {}},
                     {"henon_heiles.ham", {"--alpha", "3/10", "--beta", "h/7", "--gamma=-h/9"}},
                     {"kepler.ham", {"--scheme", "symplectic-euler-a"}},
                     {"double_pendulum.ham", {"--scheme", "gauss-4"}},
                     {"fput.ham", {}},
                     {"fput.ham", {"--scheme", "stormer-verlet"}}});
}

// Written out and in loops, by every solver.
TEST(Measure, FindsEveryKindOfStepSymplecticToRoundOff) {
  expect_symplectic({{"double_pendulum.ham", {}},
                     {"stiff_fpu.ham", {"--solver", "fixed-point"}},
                     {"pendulum.ham", {"--order", "4"}},
                     {"henon_heiles.ham", {"--scheme", "stormer-verlet"}},
                     {"kepler.ham", {"--scheme", "saba-3"}},
                     {"double_pendulum.ham", {"--scheme", "yoshida-4"}},
                     {"fput.ham", {"--alpha", "1/3", "--beta", "h/5", "--gamma=-h/7"}},
                     {"fput.ham", {"--solver", "fixed-point"}},
                     {"fput.ham", {"--alpha", "0"}},
                     {"fput.ham", {"--alpha", "1"}},
                     {"fput.ham", {"--scheme", "suzuki-4"}},
                     {"fput.ham", {"--scheme", "gauss-4", "--set", "N=12"}}});
}

// sin(pi) is 1.2e-16, and so is what the bead in the middle ever reaches: that is no size to
// compare the rounding of the others with.
TEST(Measure, TakesWhatRestsButForRoundingToBeAtRest) {
  const Scratch scratch;
  const std::string ring = scratch.write("ring.ham",
                                         "size N = 6\n"
                                         "coordinate q[1..N] periodic\n"
                                         "momentum p[1..N]\n"
                                         "H = sum(i = 1..N, p[i]^2/2 + (q[i+1] - q[i])^2/2)\n"
                                         "scene mode {\n"
                                         "  q[i] = 0.3*sin(2*pi*i/N)\n"
                                         "  h = 0.1\n"
                                         "  steps = 20\n"
                                         "}\n");
  expect_symplectic({{ring, {}}});
}

// Where beads are moved by more than their distance a step is far from where it begins, and the one
// back comes to another solution: that says nothing of the step.
TEST(Measure, LooksNearerWhereStepsComeToOtherSolutions) {
  const Scratch scratch;
  const std::string beads = scratch.write(
      "beads.ham",
      "size N = 10\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 12.1\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, 50*(q[i+1] - q[i] - 1)^2 + "
      "40*(q[i+1] - q[i] - 1)^3)\n"
      "scene s {\n  q[i] = 1.1*i\n  p[3] = 1e-3\n  h = 0.1\n  steps = 20\n}\n");
  expect_symplectic({{beads, {}}});
  EXPECT_EQ(measured(beads, {}).reversal, "tested");
}

// RK4 loses symplecticity at h^5: far above round-off, and its tangent map is its derivative.
TEST(Measure, RefutesTheClassicalRungeKuttaMethod) {
  const Measured found = measured("kepler.ham", {"--scheme", "rk4"});
  EXPECT_EQ(found.verdict, "refuted");
  EXPECT_GT(found.most, 1e-11);
  EXPECT_EQ(found.of_the_step, "tested");
}

TEST(Measure, FindsTheDefectOfSweepsAndThatItFallsWithTheirNumber) {
  // Two sweeps more multiply the defect by about h^2 H'' T'' = 0.01 * 0.03.
  double before = 1e-3;
  for (const char* sweeps : {"sweeps:1", "sweeps:3", "sweeps:5"}) {
    const Measured found = measured("pendulum.ham", {"--solver", sweeps});
    if (found.most > 1e-13) {
      EXPECT_EQ(found.verdict, "refuted") << sweeps;
      EXPECT_EQ(found.status, 5) << sweeps;
    }
    EXPECT_LT(found.most, before / 100) << sweeps;
    before = found.most;
  }
  EXPECT_GT(measured("pendulum.ham", {"--solver", "sweeps:2"}).most, 1e-9);
  const Measured loops = measured("fput.ham", {"--solver", "sweeps:2"});
  EXPECT_EQ(loops.verdict, "refuted");
  EXPECT_EQ(loops.of_the_step, "tested");
}

TEST(Measure, SaysWhatIsTooLargeForATangentMap) {
  const Result result = hamgen({"generate", HAMGEN_SOURCE_DIR "/hamiltonians/fput.ham", "--set",
                                "N=1000", "--tangent", "-o", "-"});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("2000 unknowns, of at most 512"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace hamgen::app_test
