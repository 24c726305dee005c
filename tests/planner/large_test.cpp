// Systems too large to write out keep their sums as loops, from the model to the emitted text.
#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>

#include "tests/planner/emitted_text.hpp"

namespace hamgen::planner_test {
namespace {

std::string chain(int n,
                  const std::string& potential = "(q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^3/12") {
  return "size N = " + std::to_string(n) +
         "\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
         "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, " +
         potential + ")\n";
}

std::size_t numbers_of_two_digits(const std::string& text) {
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::size_t found = 0;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    while (end < text.size() && is_digit(text[end])) ++end;
    found += end - i == 2 ? 1 : 0;
    i = end + 1;
  }
  return found;
}

TEST(LargePlan, TheTextOfALongSumDoesNotGrowWithItsLength) {
  for (const Request& request :
       {Request{}, Request{.alpha = "0"}, Request{.alpha = "3/10", .beta = "h/7", .gamma = "-h/9"},
        Request{.order = 4}, Request{.scheme = "gauss-4"}, Request{.scheme = "rk4"}}) {
    const Outcome forty = outcome(chain(40), request);
    const Outcome longer = outcome(chain(120), request);
    EXPECT_TRUE(contains(forty.plan, "stay loops")) << forty.plan;
    // Only numbers differ: 120 has a digit more than 40 wherever the size is said.
    EXPECT_LE(longer.header.size(), forty.header.size() + numbers_of_two_digits(forty.header));
    EXPECT_FALSE(contains(forty.header, "q[17]"));
  }
}

TEST(LargePlan, EulerOnALongChainIsExplicitLoops) {
  for (const char* alpha : {"0", "1"}) {
    const Outcome small = outcome(chain(64), {.alpha = alpha});
    EXPECT_TRUE(contains(small.plan, "solver: explicit, in loops\n")) << small.plan;
    EXPECT_FALSE(contains(small.header, "Verdict"));
    EXPECT_FALSE(contains(small.header, "Eigen/"));
  }
}

TEST(LargePlan, TheMidpointRuleOnALongChainIsNewtonOfSizeN) {
  const Outcome small = outcome(chain(64));
  EXPECT_TRUE(contains(small.plan, "Newton of size 64")) << small.plan;
  EXPECT_TRUE(contains(small.plan, "momenta torn out")) << small.plan;
}

TEST(LargePlan, MassesOfSeveralSumsAreOneNumberIfAllAreEqual) {
  const auto plan_of = [](const std::string& second) {
    return outcome(
               "size N = 40\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
               "H = sum(i = 1..N, p[i]^2/4) + sum(" +
               second + ") + sum(i = 1..N, (q[i+1] - q[i])^4/4)\n")
        .plan;
  };
  const std::string all = plan_of("i = 0..N-1, p[i+1]^2/8");
  EXPECT_TRUE(contains(all, "masses as an array: all are 3/4\n")) << all;
  for (const char* part : {"i = 0..N-2, p[i+1]^2/8", "i = 1..N, p[i]^2/8*i"})
    EXPECT_FALSE(contains(plan_of(part), "masses as an array")) << part;
}

// The fixed point is what a step begins with where the matrix is more work than another evaluation.
TEST(LargePlan, NewtonStandsBehindTheFixedPointUnlessItIsAskedFor) {
  const Outcome both = outcome(chain(64));
  EXPECT_TRUE(contains(both.plan,
                       "solver: fixed point, banded Newton of size 64 where it "
                       "contracts slowly; momenta torn out, in loops\n"))
      << both.plan;
  EXPECT_TRUE(contains(both.header, "ContractionRule<1> rule;"));
  EXPECT_TRUE(contains(both.header, "WaitingNewtonRule<2, 64> newton_rule;"));
  const Outcome newton = outcome(chain(64), {.solver = "newton"});
  EXPECT_TRUE(contains(newton.plan, "solver: banded Newton of size 64;")) << newton.plan;
  EXPECT_FALSE(contains(newton.header, "ContractionRule"));
  const Outcome fixed_point = outcome(chain(64), {.solver = "fixed-point"});
  EXPECT_TRUE(contains(fixed_point.plan, "solver: fixed point of size 64;")) << fixed_point.plan;
  EXPECT_FALSE(contains(fixed_point.header, "factorise"));
  // Where momenta wait for coordinates two increments say nothing of the contraction, three do.
  const Outcome coupled = outcome(
      "size N = 30\ncoordinate q[1..N] periodic\nmomentum p[1..N] periodic\n"
      "H = sum(i = 1..N, (q[i]^2 + p[i]^2)^2/4 + q[i]*q[i+1])\n");
  EXPECT_TRUE(contains(coupled.plan,
                       "solver: fixed point, banded Newton of size 60 where it contracts slowly, "
                       "in loops\n"))
      << coupled.plan;
  EXPECT_TRUE(contains(coupled.header, "ContractionRule<2> rule;"));
  EXPECT_TRUE(contains(coupled.header, "WaitingNewtonRule<2, 60> newton_rule;"));
}

// tbar is known, so that the matrix has nothing of it, and stays as narrow as that of the chain.
TEST(LargePlan, TimeIsNoMatterOfTheMatrix) {
  const auto driven = [](const std::string& before) {
    return "size N = 40\ncoordinate " + before +
           "q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\ntime t\n";
  };
  const std::string h =
      "H = sum(i = 1..N, p[i]^2/2 - cos(t)*q[i]) + sum(i = 0..N, (2 + sin(t))*(q[i+1] - q[i])^4)";
  const Outcome chain = outcome(driven("") + h + "\n");
  EXPECT_TRUE(contains(chain.plan, "banded Newton of size 41")) << chain.plan;
  EXPECT_TRUE(contains(chain.header, "using Matrix = SymmetricBandMatrix<41, 1>;"));
  const Outcome raised = outcome(driven("") + h + "\n", {.order = 4});
  EXPECT_TRUE(contains(raised.plan, "banded Newton of size 82")) << raised.plan;
  // The elements of two arrays take turns, and t is behind them.
  const Outcome two = outcome(driven("x[1..N], ") + "momentum y[1..N]\n" + h +
                              " + sum(i = 1..N, y[i]^2/2 + (x[i] - q[i])^4/4)\n");
  EXPECT_TRUE(contains(two.header, "ElementOrder<2, 40, false>")) << two.plan;
  // Where gamma moves t it is an unknown like any other, which all meet.
  const Outcome moved = outcome(driven("") + h + "\n", {.gamma = "h/9"});
  EXPECT_FALSE(contains(moved.plan, "banded")) << moved.plan;
  EXPECT_TRUE(contains(moved.plan, "bordered Newton")) << moved.plan;
}

// What all elements meet, or a few that are far apart, stands in a border around the band.
TEST(LargePlan, AVariableThatAllMeetIsABorder) {
  const Outcome wave = outcome(
      "size N = 40\ncoordinate q[1..N], f\nmomentum p[1..N], J\n"
      "H = sum(i = 1..N, p[i]^2/2) + J + sqrt(J)*sum(i = 1..N, cos(q[i] - f))\n");
  EXPECT_TRUE(contains(wave.plan, "bordered Newton of size 82")) << wave.plan;
  EXPECT_TRUE(contains(wave.plan, "within a border of 2")) << wave.plan;
  EXPECT_TRUE(contains(wave.header, "BorderOrder<80, 2, 40, false, 40, 81>")) << wave.plan;
  const Outcome last = outcome(
      "size N = 40\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
      "coordinate x\nmomentum y\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^4/4)"
      " + y^2/2 + (x - q[7])^4 + (x - q[30])^4\n");
  EXPECT_TRUE(
      contains(last.header, "using Matrix = BorderedMatrix<SymmetricBandMatrix<40, 1>, 1>;"))
      << last.plan;
  // With an element those beside it in other arrays.
  const Outcome element = outcome(
      "size N = 40\ncoordinate q[1..N], x[1..N]\nmomentum p[1..N], y[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2 + y[i]^2/2 + (q[i] - x[i])^4 + cos(q[i] - q[3]))\n");
  EXPECT_TRUE(contains(element.header, "BorderedMatrix<SymmetricBandMatrix<78, 1>, 2>"))
      << element.plan;
  EXPECT_TRUE(contains(element.header, "false, 2, 42>>;")) << element.plan;
  const Outcome free = outcome(
      "size N = 40\ncoordinate x, q[1..N]\nmomentum y, p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2) + y^2/2 + sum(i = 1..N, (q[i] - x)^4/4)\n");
  EXPECT_TRUE(
      contains(free.header,
               "ReorderedMatrix<BorderedMatrix<DiagonalMatrix<40>, 1>, BorderOrder<40, 1, 40, "
               "false, 0>>"))
      << free.plan;
}

// What stands still in a loop is computed before it, and what is added to one element behind it.
TEST(LargePlan, WhatTimeAloneMovesIsComputedBeforeTheLoop) {
  const std::string slopes =
      function_text(outcome("size N = 40\ncoordinate q[1..N]\nmomentum p[1..N]\ntime t\n"
                            "H = sum(i = 1..N, p[i]^2/2 + q[i]^4/4 - cos(3*t)*i*q[i])\n")
                        .header,
                    "void potential_gradient(");
  std::size_t at = 0;
  // The sum has a loop of its own, for it alone waits for itself.
  for (const char* text : {"std::cos(", "for (int i = 1; i <= 40; ++i)", "dq[i - 1] = ",
                           "std::sin(", "Real sum_of_dq_40 = 0.0;", "for (int i = 1; i <= 40; ++i)",
                           "sum_of_dq_40 += ", "dq[40] += sum_of_dq_40;"}) {
    at = slopes.find(text, at);
    ASSERT_NE(at, std::string::npos) << text << slopes;
  }
  EXPECT_EQ(count(slopes, "std::"), 2U) << slopes;
  // Functions of the elements are computed once, for both.
  const std::string waves =
      function_text(outcome("size N = 40\ncoordinate q[1..N]\nmomentum p[1..N]\ntime t\n"
                            "H = sum(i = 1..N, p[i]^2/2 - cos(q[i] - 3*t))\n")
                        .header,
                    "void potential_gradient(");
  EXPECT_EQ(count(waves, "std::sin("), 1U) << waves;
}

// One coordinate that all others have to do with.
TEST(LargePlan, AWaveAndItsParticlesStayLoopsButAtAHigherOrder) {
  const std::string wave =
      "size N = 24\ncoordinate x[1..N], f\nmomentum v[1..N], J\n"
      "H = sum(i = 1..N, v[i]^2/2) + J/2 + sqrt(J)*sum(i = 1..N, cos(x[i] - f))/9\n";
  EXPECT_TRUE(contains(outcome(wave).plan, "stay loops"));
  EXPECT_FALSE(contains(outcome(wave, {.order = 4}).plan, "stay loops"));
}

// What its matrix costs a ring of rotators, in evaluations of its equations.
int work_of(const std::string& potential, const Request& request) {
  const std::string header = outcome(
                                 "size N = 40\ncoordinate q[1..N] periodic\nmomentum p[1..N] "
                                 "periodic\nH = sum(i = 1..N, p[i]^2/2 + p[i]*p[i+1]/9 + " +
                                     potential + ")\n",
                                 request)
                                 .header;
  const std::string call = "start.rule.begin(";
  const std::size_t begin = header.find(call) + call.size();
  return std::atoi(header.substr(begin, 4).c_str());
}

// Evaluations are dear where there are functions; where a library adds and multiplies no row waits
// for another.
TEST(LargePlan, AMatrixCostsFewerOfDearEvaluations) {
  const std::string polynomial = "(q[i+1] - q[i])^4/4";
  const int plain = work_of(polynomial, {});
  const int functions = work_of("cos(q[i+1] - q[i]) - cos(2*q[i])*exp(sin(q[i]))", {});
  EXPECT_GT(functions, 1);
  EXPECT_GT(plain, 2 * functions);
  EXPECT_GT(plain, work_of(polynomial, {.scalar = "quad"}));
}

// K is loops over neighbours under the names of the model, and the gradient of H stays beside its.
TEST(LargePlan, AMemberOfOrderFourTakesTheGradientOfAnotherSum) {
  const Outcome raised = outcome(chain(64), {.order = 4});
  EXPECT_TRUE(contains(raised.plan,
                       "solver: fixed point, banded Newton of size 128 where it contracts slowly, "
                       "in loops\n"))
      << raised.plan;
  EXPECT_TRUE(contains(raised.plan, "K of order 4 in place of H: sums over neighbours, like H;"))
      << raised.plan;
  EXPECT_TRUE(contains(raised.header, "inline void potential_gradient("));
  const std::string slopes = function_text(raised.header, "void generating_gradient(");
  EXPECT_TRUE(contains(slopes, "const Real p_i_plus_1 = p[i];")) << slopes;
  EXPECT_TRUE(contains(slopes, "for (int i = 2; i <= 63; ++i)")) << slopes;
}

// What is cheap is computed again for each of its ends instead of waiting for memory, its terms
// apart; what is not is not.
TEST(LargePlan, ACheapChainIsGathered) {
  const std::string cheap = function_text(outcome(chain(64)).header, "void potential_gradient(");
  EXPECT_TRUE(contains(cheap, "for (int i = 2; i <= 63; ++i)")) << cheap;
  EXPECT_TRUE(contains(cheap, "q_i_minus_1")) << cheap;
  EXPECT_FALSE(contains(cheap, "2.0 * q_i")) << cheap;
  // Of 9 operations is what has functions, of 32 a polynomial, which is computed in lanes.
  const std::string quartic = "(q[i+1] - q[i])^2/2 + 3*(q[i+1] - q[i])^4/7";
  EXPECT_TRUE(
      contains(function_text(outcome(chain(64, quartic + " + (q[i+1] - q[i])^3*q[i]^2/5")).header,
                             "void potential_gradient("),
               "q_i_minus_1"));
  EXPECT_FALSE(contains(function_text(outcome(chain(64, quartic + " + cos(q[i+1] - q[i])")).header,
                                      "void potential_gradient("),
                        "q_i_minus_1"));
  const std::string dear = function_text(
      outcome(chain(64, "exp(q[i+1] - q[i]) - q[i+1] + q[i]")).header, "void potential_gradient(");
  EXPECT_FALSE(contains(dear, "q_i_minus_1")) << dear;
}

// The element that the inner loop leaves where it is is summed up beside it.
TEST(LargePlan, PairsSumUpInALocal) {
  const std::string gradient = function_text(
      outcome("size N = 40\ncoordinate q[1..N]\nmomentum p[1..N]\n"
              "H = sum(i = 1..N, p[i]^2/2) - sum(i = 1..N, j = 1..i-1, cos(q[i] - q[j]))\n")
          .header,
      "void potential_gradient(");
  EXPECT_EQ(count(gradient, "dq[i - 1] +="), 1) << gradient;
  EXPECT_EQ(count(gradient, "dq[j - 1] -="), 1) << gradient;
  EXPECT_GT(gradient.find("dq[i - 1] +="), gradient.find("dq[j - 1] -=")) << gradient;
}

TEST(LargePlan, AHarmonicChainIsFactorisedOnce) {
  const Outcome small = outcome(chain(64, "(q[i+1] - q[i])^2/2"));
  EXPECT_TRUE(contains(small.plan, "linear solve of size 64")) << small.plan;
  EXPECT_TRUE(contains(small.plan, "factorised once")) << small.plan;
  EXPECT_FALSE(contains(small.plan, "Newton")) << small.plan;
}

// What of beta, gamma, masses and drifts is zero or one is not there, in text or in memory.
TEST(LargePlan, TheMidpointRuleHasNoTraceOfBetaAndGamma) {
  const std::string header = outcome(chain(64)).header;
  const std::string code = header.substr(header.find("#pragma once"));
  for (const char* name : {"beta", "gamma", "share", "drift", "mass", "maybe_unused"}) {
    EXPECT_FALSE(contains(code, name)) << name;
  }
  const std::string general =
      outcome(chain(64), {.alpha = "3/10", .beta = "h/7", .gamma = "-h/9"}).header;
  for (const char* name : {"k.h_beta", "k.h_gamma", "k.share", "k.drift", "k.mass"}) {
    EXPECT_TRUE(contains(general, name)) << name;
  }
}

TEST(LargePlan, ASumOfSeveralTermsIsOneLoop) {
  const std::string header = outcome(chain(64)).header;
  EXPECT_EQ(count(function_text(header, "void potential_gradient("), "for (int i = 2;"), 1);
  // A kinetic energy in one quotient with the potential is separable all the same.
  const Outcome together = outcome(
      "size N = 40\ncoordinate q[1..N]\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, (p[i]^2 + q[i]^4)/2)\n");
  EXPECT_TRUE(contains(together.plan, "momenta torn out")) << together.plan;
}

TEST(LargePlan, TheMatrixFollowsThePattern) {
  auto solver = [](const std::string& sums, const char* size, const Request& request = {}) {
    return show_stage(model(std::string("size N = ") + size +
                            "\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
                            "H = sum(i = 1..N, p[i]^2/2 + q[i]^2/4)" +
                            sums + "\n"),
                      request, "plan");
  };
  const std::string ring = solver(" - sum(i = 1..N, cos(q[i+1] - q[i]))", "100");
  EXPECT_TRUE(contains(ring, "banded Newton of size 100")) << ring;
  EXPECT_TRUE(contains(ring, "bandwidth 2, the ring folded flat")) << ring;
  const std::string pairs = solver(" - sum(i = 1..N-1, j = i+1..N, cos(q[i] - q[j]))", "100");
  EXPECT_TRUE(contains(pairs, "dense Newton of size 100")) << pairs;
  // 40 that pull at 40 others: with both triangles a third of the matrix, with one a sixth.
  const std::string halves = solver(" - sum(i = 1..40, j = 61..100, cos(q[i] - q[j]))", "100");
  EXPECT_TRUE(contains(halves, "dense Newton of size 100")) << halves;
  const std::string fewer = solver(" - sum(i = 1..30, j = 71..100, cos(q[i] - q[j]))", "100");
  EXPECT_TRUE(contains(fewer, "sparse Newton of size 100")) << fewer;
  // A wide band is eliminated sooner than a sparse matrix, but solved later.
  const char* near = " - sum(i = 1..N, cos(q[i+20] - q[i]))";
  const char* far = " - sum(i = 1..N, cos(q[i+40] - q[i]))";
  const char* springs = " + sum(i = 1..N, (q[i+20] - q[i])^2)";
  const std::string torus = solver(near, "400");
  EXPECT_TRUE(contains(torus, "banded Newton of size 400")) << torus;
  const std::string wide = solver(far, "800");
  EXPECT_TRUE(contains(wide, "sparse Newton of size 800")) << wide;
  const std::string once = solver(springs, "400");
  EXPECT_TRUE(contains(once, "sparse linear solve of size 400")) << once;

  // Eigen does not know quad numbers.
  const Request quad{.scalar = "quad"};
  const std::string exact = solver(springs, "400", quad);
  EXPECT_TRUE(contains(exact, "banded linear solve of size 400")) << exact;
  const std::string exact_fewer =
      solver(" - sum(i = 1..30, j = 71..100, cos(q[i] - q[j]))", "100", quad);
  EXPECT_TRUE(contains(exact_fewer, "dense Newton of size 100")) << exact_fewer;
  const std::string too_large = solver(far, "2000", quad);
  EXPECT_TRUE(contains(too_large, "solver: fixed point of size 2000")) << too_large;
  try {
    solver(far, "2000", {.solver = "newton", .scalar = "quad"});
    ADD_FAILURE() << "a matrix of 2000 rows in quad";
  } catch (const UsageError& error) {
    EXPECT_TRUE(contains(error.what(), "does not know quad numbers\nhelp: ")) << error.what();
  }
}

TEST(LargePlan, TheProgramIsItsRecordsAndRoutines) {
  const SourceText source = model(chain(40));
  const std::string text = show_stage(source, {}, "program");
  for (const char* line :
       {"record Start:\n  value[40]  (the coordinates of zbar)\n", "  matrix: Matrix\n",
        "potential_gradient(par, q, &dq):\n", "  for i = 1..39:\n    q[i+1] = ",
        "  iterate with Newton's rule:\n    evaluate_in_parts(par, k, z, carry, start)\n",
        "    solve start.matrix x = start.lack\n"}) {
    EXPECT_TRUE(contains(text, line)) << line << text;
  }
  const std::string sweeps = show_stage(source, {.solver = "sweeps:4"}, "program");
  EXPECT_TRUE(contains(sweeps, "  4 sweeps:\n")) << sweeps;
}

// What is as large as the system is never made a second time on the stack, where 1e5 degrees of
// freedom overflowed it even in a branch that was not taken.
TEST(LargePlan, ACompositionForgetsInPlace) {
  const std::string header = outcome(chain(40), {.scheme = "yoshida-4"}).header;
  const std::string step = header.substr(header.find("class Propagator"));
  EXPECT_TRUE(contains(step, "forget(history);")) << step;
  for (const char* temporary : {"History<", "Start()"}) {
    EXPECT_EQ(count(step.substr(0, step.find(" private:")), temporary), 0) << temporary;
  }
  EXPECT_FALSE(contains(step, "history = {}")) << step;
}

TEST(LargePlan, OtherSolversKeepTheLoops) {
  for (const char* solver : {"fixed-point", "sweeps:2"}) {
    const Outcome forty = outcome(chain(40), {.solver = solver});
    const Outcome thousand = outcome(chain(1000), {.solver = solver});
    EXPECT_TRUE(contains(forty.plan, "stay loops")) << forty.plan;
    EXPECT_LT(thousand.header.size(), forty.header.size() + 400);
  }
}

TEST(LargePlan, ParametersPerDegreeOfFreedomWriteTheSumOut) {
  std::string list = "1/2";
  for (int i = 1; i < 30; ++i) list += ",1/2";
  EXPECT_FALSE(contains(outcome(chain(30), {.alpha = list}).plan, "stay loops"));
}

}  // namespace
}  // namespace hamgen::planner_test
