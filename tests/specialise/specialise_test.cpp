// What is left out for a scene, why, and what must stay.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "generator/base/source_text.hpp"
#include "generator/pipeline.hpp"
#include "tests/specialise/specialised_request.hpp"

namespace hamgen {
namespace {

// Lines of what was left out for the scene, those of the planner excepted.
std::string left_out(const std::string& model, const Changes& changes = {}) {
  const SourceText source = make_source("m.ham", model);
  const PluginSource plugin = generate_plugin(source, for_scene(source, changes));
  std::string text;
  for (const std::string& line : plugin.left_out) {
    const bool of_scene = line.find("in scene") != std::string::npos ||
                          line.find("start at 0") != std::string::npos ||
                          line.find("observed") != std::string::npos;
    if (of_scene) text += line + "\n";
  }
  return text;
}

// Mass and charge in a field, with a scene s that sets what is asked for.
std::string kepler_in_space(const std::string& scene) {
  return "coordinate x, y, z\nmomentum px, py, pz\nparameter J2 = 0\nparameter mu = 3\n"
         "let r = sqrt(x^2 + y^2 + z^2)\n"
         "H = (px^2 + py^2 + pz^2)/2 - mu/r + J2*mu*(3*z^2/r^2 - 1)/(2*r^3)\n"
         "invariant Lz = x*py - y*px\n"
         "scene s { x = 1; py = 1; h = 0.01; steps = 10; " +
         scene + " }\n";
}

TEST(Fold, PutsInZeroAndOne) {
  EXPECT_EQ(left_out(kepler_in_space("pz = 1")), "parameter J2: 0 in scene s\n");
  EXPECT_EQ(left_out(kepler_in_space("pz = 1; mu = 1; J2 = -1")),
            "parameter J2: -1 in scene s\nparameter mu: 1 in scene s\n");
  EXPECT_EQ(left_out(kepler_in_space("pz = 1; J2 = 0.001")), "");
}

TEST(Fold, KeepsWhatIsToBeKept) {
  EXPECT_EQ(left_out(kepler_in_space("pz = 1"), {.kept = {"J2"}}), "");
  EXPECT_EQ(left_out(kepler_in_space("")),
            "parameter J2: 0 in scene s\nz, pz: they start at 0, and nothing moves them\n");
  EXPECT_EQ(left_out(kepler_in_space(""), {.kept = {"J2", "z"}}), "");
  EXPECT_EQ(left_out(kepler_in_space(""), {.kept = {"J2", "pz"}}), "");
}

TEST(Fold, AnotherValueOnTheCommandLineIsAnotherSpecialisation) {
  EXPECT_EQ(left_out(kepler_in_space("pz = 1"), {.set = {{"J2", "0.1"}}}), "");
  EXPECT_EQ(left_out(kepler_in_space("pz = 1; J2 = 0.1"), {.set = {{"J2", "0"}}}),
            "parameter J2: 0 in scene s\n");
}

TEST(Fold, ExponentsAreKnown) {
  const std::string model =
      "coordinate q\nmomentum p\nparameter n = 4\nparameter a = 4\n"
      "H = p^2/2 + a*(1 + q^2)^(n/2)\nscene s { q = 1; n = ";
  const std::string end = "; h = 0.1; steps = 1 }\n";
  EXPECT_EQ(left_out(model + "3" + end), "parameter n: 3 in scene s\n");
  EXPECT_EQ(left_out(model + "5/2" + end), "parameter n: 2.5 in scene s\n");
  EXPECT_EQ(left_out(model + "1.3" + end), "");
}

TEST(Fold, EqualEntriesOfAnArrayAreOneNumber) {
  const std::string model =
      "coordinate x[1..3]\nmomentum p[1..3]\nparameter m[1..3] = [2, 3, 4]\nparameter g = 1/7\n"
      "H = sum(i = 1..3, p[i]^2/(2*m[i]) + g*m[i]*cos(x[i]))\nscene s { x[1] = 1; m = ";
  const std::string end = "; p = [1, 1, 1]; h = 0.1; steps = 1 }\n";
  EXPECT_EQ(left_out(model + "[5, 5, 5]" + end),
            "m[1..3] as an array: all entries are equal in scene s\n");
  EXPECT_EQ(left_out(model + "[1, 1, 1]" + end),
            "m[1..3] as an array: all entries are equal in scene s\n"
            "parameter m: 1 in scene s\n");
  EXPECT_EQ(left_out(model + "[5, 5, 6]" + end), "");
  EXPECT_EQ(left_out(model + "[5, 5, 5]" + end, {.kept = {"m"}}), "");
}

TEST(Fold, EqualParametersWhoseDifferenceStandsInHAreOne) {
  const std::string model =
      "coordinate x, y\nmomentum px, py\nparameter a = 2\nparameter b = 3\n"
      "H = (px^2 + py^2)/2 + a*x^2 + b*y^2 + (a - b)*x*y\nscene s { x = 1; y = 1; b = ";
  const std::string end = "; h = 0.1; steps = 1 }\n";
  EXPECT_EQ(left_out(model + "2" + end), "parameter b: equal to a in scene s\n");
  EXPECT_EQ(left_out(model + "5" + end), "");
}

TEST(Rest, PlanarMotionInSpaceHasNoThirdDimension) {
  EXPECT_EQ(left_out(kepler_in_space("J2 = 0.1")),
            "z, pz: they start at 0, and nothing moves them\n");
}

// However little it starts off the plane.
TEST(Rest, WhatStartsElsewhereStays) {
  EXPECT_EQ(left_out(kepler_in_space("J2 = 0.1; z = 1e-3")), "");
  EXPECT_EQ(left_out(kepler_in_space("J2 = 0.1; pz = 1e-300")), "");
}

// Removing what is driven until nothing changes: a drives b, b drives c.
TEST(Rest, IsTheLargestSetThatNothingMoves) {
  const std::string model =
      "coordinate w, a, b, c, d\nmomentum pw, pa, pb, pc, pd\n"
      "H = (pw^2 + pa^2 + pb^2 + pc^2 + pd^2)/2 + w^4/4 + w^2*a + a^2*b + b*c + w*d^2\n"
      "scene s { w = 1; h = 0.1; steps = 1 }\n";
  EXPECT_EQ(left_out(model), "d, pd: they start at 0, and nothing moves them\n");
}

TEST(Rest, AlsoOfElementsOfAnArray) {
  const std::string model =
      "coordinate q[1..3]\nmomentum p[1..3]\n"
      "H = sum(i = 1..3, p[i]^2/2 + q[i]^4/4) + q[1]^2*q[2]^2\n"
      "scene s { q[1] = 1; q[2] = 1; h = 0.1; steps = 1 }\n";
  EXPECT_EQ(left_out(model), "q[3], p[3]: they start at 0, and nothing moves them\n");
}

// Where everything rests there is nothing to leave out, and time never rests.
TEST(Rest, IsNotAllThereIs) {
  EXPECT_EQ(left_out("coordinate q\nmomentum p\nH = p^2/2 - cos(q)\n"
                     "scene s { h = 0.1; steps = 1 }\n"),
            "");
  EXPECT_EQ(left_out("coordinate q\nmomentum p\ntime t\nH = p^2/2 + cos(t)*q^2\n"
                     "scene s { h = 0.1; steps = 1 }\n"),
            "q, p: they start at 0, and nothing moves them\n");
}

// |y| has no derivative where y rests, and sqrt(y^2) hides it.
TEST(Rest, IsNotSaidOfACorner) {
  for (const char* term : {"abs(y)", "sqrt(y^2)", "(y^2)^(3/2)", "y*atan2(y, y)"}) {
    EXPECT_EQ(left_out(fmt::format("coordinate x, y\nmomentum px, py\n"
                                   "H = (px^2 + py^2)/2 + x^4 + {}\n"
                                   "scene s {{ x = 1; h = 0.1; steps = 1 }}\n",
                                   term)),
              "")
        << term;
  }
}

TEST(Rest, EndsWhereCMovesIt) {
  const std::string model =
      "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + x^4 + x^2*y^2\n"
      "scene s { x = 1; h = 0.1; steps = 1 }\n";
  const std::string rests = "y, py: they start at 0, and nothing moves them\n";
  EXPECT_EQ(left_out(model), rests);
  EXPECT_EQ(left_out(model, {.request = {.beta = "h/7, h/9"}}), rests);
  EXPECT_EQ(left_out(model, {.request = {.beta = "[[h/7, h/9], [h/9, 0]]"}}), "");
  EXPECT_EQ(left_out(model, {.request = {.gamma = "[[h/7, h], [h, 0]]"}}), "");
  EXPECT_EQ(left_out(model, {.request = {.scheme = "yoshida-4"}}), rests);
  EXPECT_EQ(left_out(model, {.request = {.scheme = "gauss-4"}}), rests);
  EXPECT_EQ(left_out(model, {.request = {.order = 4}}), rests);
  EXPECT_EQ(left_out(model, {.request = {.scheme = "stormer-verlet"}}), rests);
}

// A C outside sp(2n) makes no symplectic step: then nothing is said.
TEST(Rest, IsOfSymplecticMembers) {
  const std::string model =
      "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + x^4 + x^2*y^2\n"
      "scene s { x = 1; h = 0.1; steps = 1 }\n";
  EXPECT_EQ(left_out(model, {.request = {.gauge = "[[1/3, 0, 1/5, 0], [0, 0, 0, 0], "
                                                  "[1/7, 0, 1/2, 0], [0, 0, 0, 0]]"}}),
            "");
}

// Loops lose whole arrays.
TEST(Rest, AlsoWhereSumsStayLoops) {
  const std::string model =
      "size N = 30\ncoordinate x[1..N], y[1..N] with x[0] = 0, x[N+1] = 0, y[0] = 0, y[N+1] = 0\n"
      "momentum px[1..N], py[1..N]\n"
      "H = sum(i = 1..N, (px[i]^2 + py[i]^2)/2) + sum(i = 0..N, (x[i+1] - x[i])^2/2 + "
      "((x[i+1] - x[i])^2 + (y[i+1] - y[i])^2)^2/4)\n"
      "scene s { x[i] = sin(i); h = 0.1; steps = 1 ";
  EXPECT_EQ(left_out(model + "}\n"), "y, py: they start at 0, and nothing moves them\n");
  EXPECT_EQ(left_out(model + "; y[7] = 1e-9 }\n"), "");
}

const std::string kPolarMotion =
    "coordinate r, phi, u\nmomentum pr, pphi, pu\nparameter k = 2\n"
    "H = pr^2/2 + pphi^2/(2*r^2) - k/r + pu^2/2 + u^4/4\ninvariant L = pphi\n"
    "scene s { r = 1; pphi = 1.1; u = 1; h = 0.01; steps = 10";

TEST(Observe, WithoutItEverythingIsObserved) {
  EXPECT_EQ(left_out(kPolarMotion + " }\n"), "");
  EXPECT_EQ(left_out(kPolarMotion + "; observe energy, L }\n"), "");
}

TEST(Observe, LeavesOutWhatDoesNotMatter) {
  EXPECT_EQ(left_out(kPolarMotion + "; observe r }\n"),
            "u, pu: nothing observed depends on them\n"
            "phi: cyclic and not observed; pphi is a parameter\n");
  EXPECT_EQ(left_out(kPolarMotion + "; observe r, energy }\n"),
            "phi: cyclic and not observed; pphi is a parameter\n");
  EXPECT_EQ(left_out(kPolarMotion + "; observe phi }\n"),
            "u, pu: nothing observed depends on them\n");
  EXPECT_EQ(left_out(kPolarMotion + "; observe u }\n"),
            "r, phi, pr, pphi: nothing observed depends on them\n");
  EXPECT_EQ(left_out(kPolarMotion + "; observe both = r*u }\n"),
            "phi: cyclic and not observed; pphi is a parameter\n");
}

// pbar of phi is no constant under beta: H_pphi moves it.
TEST(Observe, ACyclicMomentumUnderBetaStays) {
  EXPECT_EQ(left_out(kPolarMotion + "; observe r }\n", {.request = {.beta = "h/7"}}),
            "u, pu: nothing observed depends on them\n");
  EXPECT_EQ(left_out(kPolarMotion + "; observe r }\n", {.request = {.beta = "h/7, 0, 0"}}),
            "u, pu: nothing observed depends on them\n"
            "phi: cyclic and not observed; pphi is a parameter\n");
}

// Where sums stay loops arrays go as a whole.
TEST(Observe, LeavesOutArraysOfLoops) {
  const auto model = [](const std::string& coupling, const std::string& observe) {
    return "size N = 30\ncoordinate x[1..N], y[1..N] with x[0] = 0, x[N+1] = 0, y[0] = 0, y[N+1] = "
           "0\nmomentum px[1..N], py[1..N]\n"
           "H = sum(i = 1..N, (px[i]^2 + py[i]^2)/2) + sum(i = 0..N, (x[i+1] - x[i])^4/4 + (y[i+1] "
           "- "
           "y[i])^2/2" +
           coupling + ")\nscene s { x[i] = sin(i); y[i] = cos(i); h = 0.1; steps = 1; observe " +
           observe + " }\n";
  };
  EXPECT_EQ(left_out(model("", "x[3]")), "y, py: nothing observed depends on them\n");
  EXPECT_EQ(left_out(model("", "total = sum(i = 1..30, px[i])")),
            "y, py: nothing observed depends on them\n");
  EXPECT_EQ(left_out(model("", "x[3], y[1]")), "");
  EXPECT_EQ(left_out(model("", "x[3], energy")), "");
  EXPECT_EQ(left_out(model(" + x[i]*y[i]^2", "x[3]")), "");
}

// The proof that it may be, and that what is coupled may not.
TEST(Observe, OfLoopsIsProved) {
  const SourceText source = make_source(
      "m.ham",
      "size N = 26\ncoordinate x[1..N], y[1..N] with x[0] = 0, x[N+1] = 0, y[0] = 0, y[N+1] = 0\n"
      "momentum px[1..N], py[1..N]\n"
      "H = sum(i = 1..N, (px[i]^2 + py[i]^2)/2) + sum(i = 0..N, (x[i+1] - x[i])^4/4 + (y[i+1] - "
      "y[i])^2/2)\nscene s { x[i] = sin(i); y[i] = cos(i); h = 0.1; steps = 1; observe x[3] }\n");
  const Proof proof = verify_step(source, for_scene(source));
  for (const char* property : {"emitted code", "specialised"}) {
    const auto found = std::ranges::find(proof, property, &Finding::property);
    ASSERT_NE(found, proof.end());
    EXPECT_EQ(found->verdict, Verdict::proved) << found->detail;
  }
}

// Explicit steps of a polynomial leave no domain: nobody looks at each of them.
TEST(Look, AtEveryStepIsLeftOutForPolynomials) {
  const auto says = [](const std::string& potential, const std::string& scheme) {
    const SourceText source =
        make_source("m.ham", "coordinate q\nmomentum p\nparameter a = 2\nH = p^2/2 + " + potential +
                                 "\nscene s { q = 1; h = 0.1; steps = 1 }\n");
    const PluginSource plugin = generate_plugin(
        source, for_scene(source, {.request = {.scheme = scheme}}), HeaderText::without_proof);
    const bool said = std::ranges::any_of(plugin.left_out, [](const std::string& line) {
      return line.starts_with("a look at every step");
    });
    EXPECT_EQ(said, plugin.header.text.find("length <=") == std::string::npos);
    return said;
  };
  for (const char* scheme : {"stormer-verlet", "symplectic-euler-a", "rk4", "forest-ruth-4"})
    EXPECT_TRUE(says("q^4/(4*a) + q^3/3", scheme)) << scheme;
  EXPECT_FALSE(says("q^4", "implicit-midpoint"));
  EXPECT_FALSE(says("q^4", "gauss-4"));
  for (const char* potential : {"1/q", "sqrt(1 + q^2)", "q^(3/2)", "log(q)", "exp(q)"})
    EXPECT_FALSE(says(potential, "stormer-verlet")) << potential;
}

// Ht is made of all of H, whatever else is looked at.
TEST(Observe, TheModifiedHamiltonianTakesEverything) {
  EXPECT_EQ(left_out(kPolarMotion + "; observe r }\n",
                     {.request = {.watch_modified = 2, .step = Rational(1, 100)}}),
            "");
}

TEST(Observe, ALongerListIsTakenFromTheCommandLine) {
  EXPECT_EQ(left_out(kPolarMotion + "; observe r }\n", {.observe = "r, v = u^2"}),
            "phi: cyclic and not observed; pphi is a parameter\n");
}

}  // namespace
}  // namespace hamgen
