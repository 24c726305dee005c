// The required outcomes of the planner, each on its plan and on the text that is emitted for it.
#include <gtest/gtest.h>

#include "tests/planner/emitted_text.hpp"

namespace hamgen::planner_test {
namespace {

const Request midpoint{.scheme = "implicit-midpoint"};
const Request euler_a{.scheme = "symplectic-euler-a"};
const Request euler_b{.scheme = "symplectic-euler-b"};

// No iteration, no start values, no stopping rule anywhere in the text.
void expect_no_solver(const Outcome& small) {
  EXPECT_FALSE(contains(small.solve, "for (")) << small.solve;
  EXPECT_FALSE(contains(small.solve, "while")) << small.solve;
  for (const char* part : {"Verdict", "History", "struct Start", "eliminate", "Eigen"}) {
    EXPECT_FALSE(contains(small.header, part)) << part << "\n" << small.header;
  }
}

// One loop in the step, with the rule that stops it.
void expect_newton(const Outcome& small, int loops = 1) {
  EXPECT_EQ(count(small.solve, "for (int iteration"), loops) << small.solve;
  EXPECT_TRUE(contains(small.header, "struct NewtonRule"));
}

TEST(Plan, SymplecticEulerOnASeparableHamiltonianNeedsNoSolver) {
  const std::string text = one + "H = p^2/2 - cos(q)\n";
  const Outcome a = outcome(text, euler_a);
  EXPECT_EQ(a.plan,
            "solver: explicit\n"
            "assign q\n"
            "assign p\n"
            "left out:\n"
            "  beta terms: beta = 0\n"
            "  gamma terms: gamma = 0\n"
            "  equation solver: the step is explicit\n");
  expect_no_solver(a);
  EXPECT_FALSE(contains(a.solve, " / ")) << a.solve;

  const Outcome b = outcome(text, euler_b);
  EXPECT_EQ(b.plan,
            "solver: explicit\n"
            "assign p\n"
            "assign q\n"
            "left out:\n"
            "  beta terms: beta = 0\n"
            "  gamma terms: gamma = 0\n"
            "  equation solver: the step is explicit\n");
  expect_no_solver(b);
}

// The last increment corrects it to as many digits.  Where it is linear with constant coefficients
// it is cheaper to compute.
TEST(Plan, AGradientOfTheIterationIsNotEvaluatedOnceMoreAtItsEnd) {
  const std::string solve = outcome(one + "H = cosh(p) - cos(q)\n").solve;
  EXPECT_EQ(count(solve, "std::sinh("), 1) << solve;
  EXPECT_EQ(count(solve, "std::sin("), 1) << solve;
  const std::string root = outcome(one + "H = sqrt(1 + p^2) + exp(q)\n").solve;
  EXPECT_EQ(count(root, "std::sqrt("), 1) << root;
  EXPECT_EQ(count(root, "std::exp("), 1) << root;
}

// The last kick is where the next step begins: of n + 1 kicks the forces of n are evaluated.
TEST(Plan, TheForceOfTheLastKickIsThatOfTheNextStepsFirst) {
  for (const char* scheme : {"stormer-verlet", "sbab-3"}) {
    const std::string solve = outcome(one + "H = p^2/2 - cos(q)\n", {.scheme = scheme}).solve;
    const std::size_t guarded = solve.find("if (!start.known)");
    ASSERT_NE(guarded, std::string::npos) << solve;
    EXPECT_EQ(solve.find("potential_gradient("), solve.find("potential_gradient(", guarded))
        << solve;
    EXPECT_GT(solve.find("start.known = report.converged;"), guarded) << solve;
    EXPECT_TRUE(contains(solve, "start.known = report.converged;")) << solve;
  }
  // It ends with a drift: nothing is known.
  EXPECT_FALSE(
      contains(outcome(one + "H = p^2/2 - cos(q)\n", {.scheme = "ruth-3"}).solve, "start.known"));
}

TEST(Plan, TheMembersAlphaZeroAndOneAreTheEulerSchemes) {
  const std::string text = one + "H = p^2/2 - cos(q)\n";
  for (const auto& [alpha, named] : {std::pair{"0", euler_a}, std::pair{"1", euler_b}}) {
    const Request member{.alpha = alpha};
    EXPECT_EQ(outcome(text, member).header, outcome(text, named).header);
  }
}

TEST(Plan, AMomentumThatEntersQuadraticallyIsARootInClosedForm) {
  const std::string text = one + "H = (q^2 + 1)*(p^2 + 1)/2\n";
  const Outcome a = outcome(text, euler_a);
  EXPECT_EQ(a.plan,
            "solver: quadratic equation for p, root in closed form\n"
            "assign q\n"
            "quadratic equation for p, root in closed form\n"
            "left out:\n"
            "  beta terms: beta = 0\n"
            "  gamma terms: gamma = 0\n");
  expect_no_solver(a);
  EXPECT_EQ(count(a.solve, "sqrt("), 1) << a.solve;

  const Outcome b = outcome(text, euler_b);
  EXPECT_TRUE(contains(b.plan, "quadratic equation for q, root in closed form\n")) << b.plan;
  expect_no_solver(b);
}

TEST(Plan, AMomentumThatEntersAffinelyIsAWrittenOutLinearSolve) {
  const std::string text = one + "H = p*sin(q)\n";
  const Outcome a = outcome(text, euler_a);
  EXPECT_EQ(a.plan,
            "solver: linear solve of size 1 for p\n"
            "assign q\n"
            "linear solve of size 1 for p\n"
            "left out:\n"
            "  beta terms: beta = 0\n"
            "  gamma terms: gamma = 0\n");
  expect_no_solver(a);
  EXPECT_EQ(count(a.solve, " / "), 1) << a.solve;

  // The other way round sin(q) is in the way.
  const Outcome b = outcome(text, euler_b);
  EXPECT_TRUE(contains(b.plan, "Newton of size 1 on q\nassign p\n")) << b.plan;
  expect_newton(b);
}

TEST(Plan, MomentaThatEnterAffinelyInSeveralDegreesOfFreedomAreOneLinearSolve) {
  const Outcome a = outcome(two + "H = p1*sin(q2) + p2*cos(q1*q2)\n", euler_a);
  EXPECT_TRUE(contains(a.plan, "solver: linear solve of size")) << a.plan;
  EXPECT_FALSE(contains(a.plan, "Newton")) << a.plan;
  expect_no_solver(a);
}

TEST(Plan, EulerOnTheDoublePendulumIsNewtonOfSizeN) {
  const Outcome a = outcome(double_pendulum, euler_a);
  EXPECT_EQ(a.plan,
            "solver: Newton of size 2 on p1, p2\n"
            "assign q1\n"
            "assign q2\n"
            "Newton of size 2 on p1, p2\n"
            "left out:\n"
            "  beta terms: beta = 0\n"
            "  gamma terms: gamma = 0\n");
  expect_newton(a);
  // The angles do not change in the iteration: neither do their sines and cosines.
  const std::string loop = a.solve.substr(a.solve.find("for (int iteration"));
  EXPECT_FALSE(contains(loop, "std::sin")) << loop;
  EXPECT_FALSE(contains(loop, "std::cos")) << loop;

  const Outcome b = outcome(double_pendulum, euler_b);
  EXPECT_TRUE(contains(b.plan, "Newton of size 2 on q1, q2\n")) << b.plan;
  EXPECT_FALSE(contains(b.plan, "of size 4")) << b.plan;
  expect_newton(b);
}

TEST(Plan, TheMidpointRuleTearsOutMomentaOfAQuadraticKineticEnergy) {
  const Outcome pendulum = outcome(one + "H = p^2/2 - cos(q)\n", midpoint);
  EXPECT_EQ(pendulum.plan,
            "solver: Newton of size 1 on q; p torn out\n"
            "derivatives ahead\n"
            "left out:\n"
            "  beta terms: beta = 0\n"
            "  gamma terms: gamma = 0\n"
            "  1 of the unknowns: torn out\n");
  expect_newton(pendulum);
  EXPECT_TRUE(contains(pendulum.header, "Real value[1]")) << "one unknown";
  EXPECT_FALSE(contains(pendulum.solve, "R_p")) << pendulum.solve;

  const Outcome kepler =
      outcome(two + "parameter m = 2\nH = (p1^2 + p2^2)/(2*m) - 1/sqrt(q1^2 + q2^2)\n", midpoint);
  EXPECT_TRUE(contains(kepler.plan, "Newton of size 2 on q1, q2; p1, p2 torn out\n"))
      << kepler.plan;
  expect_newton(kepler);
}

TEST(Plan, AKineticEnergyWithCrossTermsStillLeavesNewtonOfSizeN) {
  const Outcome small =
      outcome(two + "H = p1^2/2 + p1*p2/3 + p2^2/2 - cos(q1) - cos(q1 - q2)\n", midpoint);
  EXPECT_TRUE(contains(small.plan, "Newton of size 2 on q1, q2; p1, p2 torn out\n")) << small.plan;
  expect_newton(small);
}

TEST(Plan, AMemberWithBetaAndGammaStillTearsOutTheMomenta) {
  const Request member{.alpha = "3/10", .beta = "h/7", .gamma = "-h/9"};
  const Outcome small = outcome(one + "H = p^2/2 - cos(q)\n", member);
  EXPECT_TRUE(contains(small.plan, "Newton of size 1 on q; p torn out\n")) << small.plan;
  EXPECT_FALSE(contains(small.plan, "beta = 0")) << small.plan;
  EXPECT_FALSE(contains(small.plan, "gamma = 0")) << small.plan;
  expect_newton(small);
}

TEST(Plan, AQuadraticHamiltonianHasItsMatrixHoistedOutOfTheStep) {
  const Outcome oscillator = outcome(one + "parameter w = 2\nH = p^2/2 + w^2*q^2/2\n", midpoint);
  EXPECT_EQ(oscillator.plan,
            "solver: linear solve of size 2 for q, p, constant matrix hoisted\n"
            "left out:\n"
            "  beta terms: beta = 0\n"
            "  gamma terms: gamma = 0\n");
  expect_no_solver(oscillator);
  EXPECT_FALSE(contains(oscillator.solve, " / ")) << oscillator.solve;
  EXPECT_FALSE(has_name(oscillator.solve, "w")) << oscillator.solve;
  EXPECT_TRUE(contains(function_text(oscillator.header, "Coefficients prepare("), "1.0 / "));
}

TEST(Plan, TheConstantMatrixOfSeveralCoupledOscillatorsIsHoistedToo) {
  const Outcome small = outcome(
      "coordinate q[1..3]\nmomentum p[1..3]\nparameter k = 1\n"
      "H = sum(i = 1..3, p[i]^2/2) + k*(q[1] - q[2])^2/2 + k*(q[2] - q[3])^2/2 + q[1]^2\n",
      midpoint);
  EXPECT_TRUE(contains(small.plan, "constant matrix hoisted")) << small.plan;
  EXPECT_FALSE(contains(small.plan, "Newton")) << small.plan;
  EXPECT_FALSE(contains(small.solve, "for (")) << small.solve;
  EXPECT_FALSE(contains(small.solve, " / ")) << small.solve;
}

TEST(Plan, ZeroAndConstantHamiltoniansChangeNothing) {
  for (const char* h : {"H = 0\n", "H = 7\n", "H = q*p - p*q\n", "H = (q - q)*cos(p)\n"}) {
    for (const Request& request :
         {midpoint, euler_a, euler_b, Request{.alpha = "3/10", .beta = "1"}}) {
      const Outcome small = outcome(one + h, request);
      EXPECT_TRUE(contains(small.plan, "solver: explicit\n")) << small.plan;
      EXPECT_TRUE(contains(small.plan, "updates of q, p: constant\n")) << small.plan;
      expect_no_solver(small);
      EXPECT_FALSE(contains(small.solve, "dz.q")) << small.solve;
      EXPECT_FALSE(contains(small.solve, "dz.p")) << small.solve;
    }
  }
}

TEST(Plan, LinearHamiltoniansArePlainAssignments) {
  for (const Request& request :
       {midpoint, euler_a, euler_b, Request{.alpha = "3/10", .beta = "1"}}) {
    const Outcome drift = outcome(one + "H = p\n", request);
    EXPECT_TRUE(contains(drift.plan, "solver: explicit\n")) << drift.plan;
    EXPECT_TRUE(contains(drift.solve, "dz.q = h + carry.q;")) << drift.solve;
    EXPECT_FALSE(contains(drift.solve, "dz.p")) << drift.solve;
    expect_no_solver(drift);

    const Outcome kick = outcome(one + "H = q\n", request);
    EXPECT_TRUE(contains(kick.solve, "dz.p = -(h - carry.p);")) << kick.solve;
    EXPECT_FALSE(contains(kick.solve, "dz.q")) << kick.solve;
    expect_no_solver(kick);
  }
}

TEST(Plan, FreeMotionNeedsNoSolverUnlessBetaCouplesTheMomentaToTheCoordinates) {
  // Pbar = p + beta (q - Q) = p - h beta Pbar: a linear solve with a constant matrix.
  const Outcome coupled = outcome(two + "H = p1^2/2\n", {.alpha = "3/10", .beta = "1"});
  EXPECT_TRUE(contains(coupled.plan, "linear solve of size 1 for p1, constant matrix hoisted\n"));
  expect_no_solver(coupled);

  for (const Request& request :
       {midpoint, euler_a, euler_b, Request{.alpha = "3/10", .gamma = "1"}}) {
    const Outcome free = outcome(two + "H = p1^2/2\n", request);
    EXPECT_TRUE(contains(free.plan, "solver: explicit\n")) << free.plan;
    EXPECT_TRUE(contains(free.solve, "dz.q1 = carry.q1 + h * p1;")) << free.solve;
    EXPECT_EQ(count(free.solve, "dz.q2"), 0) << free.solve;
    expect_no_solver(free);
  }
}

TEST(Plan, IndependentSystemsAreIndependentBlocks) {
  const Outcome small = outcome(two + "H = p1^2/2 - cos(q1) + p2^2/2 - cos(q2)\n", midpoint);
  EXPECT_EQ(
      small.plan,
      "solver: Newton of size 1 on q1; p1 torn out, then Newton of size 1 on q2; p2 torn out\n"
      "Newton of size 1 on q1; p1 torn out\n"
      "Newton of size 1 on q2; p2 torn out\n"
      "left out:\n"
      "  beta terms: beta = 0\n"
      "  gamma terms: gamma = 0\n"
      "  2 of the unknowns: torn out\n");
  expect_newton(small, 2);
  // Negative control: a coupling joins them.
  const Outcome coupled =
      outcome(two + "H = p1^2/2 - cos(q1) + p2^2/2 - cos(q2) + q1*q2\n", midpoint);
  EXPECT_TRUE(contains(coupled.plan, "Newton of size 2 on q1, q2; p1, p2 torn out\n"))
      << coupled.plan;
  expect_newton(coupled, 1);
}

TEST(Plan, OneWayCouplingGivesSuccessiveBlocks) {
  // Under alpha = 0 the equation of q1's momentum does not need p2, but that of p2 needs p1.
  const Outcome small = outcome(two + "H = exp(p1)*q1 + p2^2*p1 + q2*exp(p2)\n", euler_a);
  EXPECT_TRUE(contains(small.plan, "Newton of size 1 on p1\nNewton of size 1 on p2\n") ||
              contains(small.plan, "Newton of size 1 on p2\nNewton of size 1 on p1\n"))
      << small.plan;
  expect_newton(small, 2);
}

TEST(Plan, CyclicCoordinatesAndUnusedParametersAreAbsent) {
  for (const Request& request : {midpoint, euler_a, euler_b}) {
    const Outcome small = outcome(two +
                                      "parameter g = 1\nparameter idle = 2\n"
                                      "H = p1^2/2 - g*cos(q1) + p2^2/2\n",
                                  request);
    EXPECT_TRUE(contains(small.plan, "  stage values of q2: H does not depend on them\n"));
    EXPECT_TRUE(contains(small.plan, "  updates of p2: constant\n"));
    EXPECT_TRUE(contains(small.plan, "  parameters idle: the step does not use them\n"));
    // q2 is advanced and never read.
    EXPECT_FALSE(contains(small.solve, "z.q2;")) << small.solve;
    EXPECT_FALSE(contains(small.solve, "q2_bar")) << small.solve;
    EXPECT_TRUE(contains(small.solve, "dz.q2 = ")) << small.solve;
    EXPECT_FALSE(contains(small.solve, "dz.p2")) << small.solve;
    EXPECT_FALSE(has_name(small.solve, "idle")) << small.solve;
    const std::string step = function_text(small.header, "StepReport step(const Parameters&");
    EXPECT_FALSE(contains(step, "z.p2 +=")) << step;
  }
}

TEST(Plan, ADegreeOfFreedomThatHDoesNotHaveCostsNothing) {
  const Outcome small = outcome(two + "H = p1^2/2 - cos(q1)\n", midpoint);
  EXPECT_FALSE(contains(small.solve, "q2")) << small.solve;
  EXPECT_FALSE(contains(small.solve, "p2")) << small.solve;
}

TEST(Plan, ZeroBetaAndGammaAreAbsentAndOthersArePresent) {
  const std::string text = one + "parameter b = 1\nparameter c = 2\nH = p^2/2 - cos(q)\n";
  struct Case {
    Request request;
    bool beta, gamma;
  };
  for (const Case& c :
       {Case{{.alpha = "1/2"}, false, false}, Case{{.alpha = "1/2", .beta = "b*h"}, true, false},
        Case{{.alpha = "1/2", .gamma = "c*h"}, false, true},
        Case{{.alpha = "1/2", .beta = "b*h", .gamma = "c*h"}, true, true},
        Case{{.alpha = "1/2", .beta = "b - b", .gamma = "0*c"}, false, false}}) {
    const Outcome small = outcome(text, c.request);
    EXPECT_EQ(contains(small.plan, "beta terms: beta = 0"), !c.beta) << small.plan;
    EXPECT_EQ(contains(small.plan, "gamma terms: gamma = 0"), !c.gamma) << small.plan;
    const std::string prepare = function_text(small.header, "Coefficients prepare(");
    EXPECT_EQ(has_name(prepare, "b"), c.beta) << prepare;
    EXPECT_EQ(has_name(prepare, "c"), c.gamma) << prepare;
    EXPECT_FALSE(has_name(small.solve, "b")) << small.solve;
    EXPECT_FALSE(has_name(small.solve, "c")) << small.solve;
  }
}

TEST(Plan, ZeroEntriesOfAListAreAbsentToo) {
  const Outcome small = outcome(two + "parameter b = 1\nH = p1^2/2 - cos(q1) + p2^2/2 - cos(q2)\n",
                                {.alpha = "0,1/2", .beta = "0,b*h", .gamma = "0,0"});
  EXPECT_TRUE(contains(small.plan, "assign q1\n")) << small.plan;
  EXPECT_TRUE(contains(small.plan, "assign p1\n")) << small.plan;
  EXPECT_TRUE(contains(small.plan, "Newton of size 1 on q2; p2 torn out\n")) << small.plan;
  expect_newton(small, 1);
}

TEST(Plan, TheGammaTermAloneMakesEulerImplicit) {
  // alpha = 0: Qbar = q + gamma (p - P); with gamma = 0 it is q and the step explicit.
  const Outcome small = outcome(one + "H = p^2/2 - cos(q)\n", {.alpha = "0", .gamma = "h/12"});
  EXPECT_TRUE(contains(small.plan, "Newton of size 1 on q")) << small.plan;
  expect_newton(small);
}

TEST(Plan, FixedPointAndSweepsSaySo) {
  const std::string text = one + "H = p^2/2 - cos(q)\n";
  const Outcome fixed = outcome(text, {.solver = "fixed-point"});
  EXPECT_TRUE(contains(fixed.plan, "solver: fixed point of size ")) << fixed.plan;
  EXPECT_FALSE(contains(fixed.header, "NewtonRule"));
  // dH/dq = sin q; its derivative is nobody's need.
  EXPECT_FALSE(contains(fixed.solve, "std::cos")) << fixed.solve;

  const Outcome sweeps = outcome(text, {.solver = "sweeps:3"});
  EXPECT_EQ(sweeps.plan.substr(0, sweeps.plan.find("left out")),
            "solver: 3 fixed-point sweeps (Algorithm 1 of the paper): not symplectic\n"
            "predict Z by explicit Euler; sweep all stage values together\n");
  EXPECT_FALSE(contains(sweeps.header, "Verdict"));
  EXPECT_FALSE(contains(sweeps.solve, "std::cos")) << sweeps.solve;
}

TEST(Plan, TimeIsAnAssignmentOutsideEveryBlock) {
  const Outcome small = outcome(one + "time t\nH = p^2/2 + (1 + cos(t)/5)*q^4/4\n", midpoint);
  EXPECT_TRUE(contains(small.plan, "assign t\n")) << small.plan;
  EXPECT_TRUE(contains(small.plan, "Newton of size 1 on q; p torn out\n")) << small.plan;
  expect_newton(small);
}

TEST(Plan, FoldedParametersAreNumbers) {
  const Outcome small =
      outcome(one + "parameter eps = 0.03\nH = p^2/2 - eps*cos(q)\n", {.fold = {"eps"}});
  EXPECT_FALSE(has_name(small.solve, "eps")) << small.solve;
  const std::string derivatives = function_text(small.header, "void derivatives(");
  EXPECT_FALSE(has_name(derivatives, "eps")) << derivatives;
  EXPECT_TRUE(contains(derivatives, "0.03")) << derivatives;
}

}  // namespace
}  // namespace hamgen::planner_test
