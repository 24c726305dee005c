// False claims, of every kind that points and rounding once let pass: each must be caught.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "generator/base/diagnostic.hpp"
#include "generator/pipeline.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/verify/precise.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {
namespace {

SourceText model(const std::string& text) { return make_source("trust.ham", text); }

SourceText of_one(const std::string& h, const std::string& more = "") {
  return model("coordinate q\nmomentum p\nH = " + h + "\n" + more);
}

Finding finding_of(const Proof& proof, const std::string& property) {
  for (const Finding& f : proof) {
    if (f.property == property) return f;
  }
  return {"missing", Verdict::measured};
}

Finding finding(const SourceText& source, const Request& request, const std::string& property) {
  return finding_of(verify_step(source, request), property);
}

Verdict verdict_of(const SourceText& source, const Request& request, const std::string& property) {
  return finding(source, request, property).verdict;
}

const std::vector<Verdict> kAll = {Verdict::proved, Verdict::tested, Verdict::refuted,
                                   Verdict::not_decided};

// A true one: the matrix of the second block is not symmetric, that of the first, which has the
// same name, is.
TEST(Verdicts, OfBlocksOneAfterTheOtherKnowTheirOwnMatrices) {
  const SourceText source = model(
      "coordinate q[1..4]\nmomentum p[1..4]\ncoordinate r[1..2]\nmomentum s[1..2]\n"
      "H = sum(i = 1..4, p[i]^2/2 + cos(q[i]) + q[i]^4)"
      " + sum(i = 1..4, j = i+1..4, q[i]^2*q[j]^2)"
      " + sum(i = 1..2, s[i]^2/2*(1 + r[i]^2)) + s[1]*s[2]*r[1]^3*4 + (r[1] - r[2])^4*s[1]"
      " + 3*r[1]*s[2]\n");
  const Proof proof = verify_step(source, {});
  EXPECT_EQ(finding_of(proof, "program").verdict, Verdict::proved);
  EXPECT_EQ(finding_of(proof, "emitted code").verdict, Verdict::proved);
}

TEST(Verdicts, OfTwoStatementsAreThoseOfTheWeaker) {
  for (const Verdict a : kAll) {
    EXPECT_EQ(both(a, a), a);
    EXPECT_EQ(both(a, Verdict::proved), a);
    EXPECT_EQ(both(a, Verdict::refuted), Verdict::refuted);
    for (const Verdict b : kAll) EXPECT_EQ(both(a, b), both(b, a));
  }
  EXPECT_EQ(both(Verdict::tested, Verdict::not_decided), Verdict::not_decided);
  EXPECT_EQ(both(Verdict::proved, Verdict::measured), Verdict::not_decided);
}

TEST(Verdicts, OfAConclusionAreNoBetterThanItsPremise) {
  for (const Verdict premise : kAll) {
    EXPECT_EQ(resting_on(premise, Verdict::refuted), Verdict::refuted);
    for (const Verdict conclusion : {Verdict::proved, Verdict::tested}) {
      const Verdict found = resting_on(premise, conclusion);
      EXPECT_NE(found, Verdict::refuted);
      if (holds(found)) {
        EXPECT_TRUE(holds(premise));
        EXPECT_GE(found, premise);
      }
    }
  }
  const Finding weak =
      resting_on(Verdict::tested, "a reason", {"symplectic", Verdict::proved, "by algebra"});
  EXPECT_EQ(weak.verdict, Verdict::tested);
  EXPECT_EQ(weak.detail, "by algebra; a reason");
}

// A ball and a one-sided spring, touched where q < 0.
const std::string kContact =
    "coordinate q\nmomentum p\nparameter k = 100\nH = p^2/2 + k*(abs(q) - q)^2/8\n"
    "invariant P = p\nscene s { q = 1; p = -1; h = 0.01; steps = 1000 }\n";

TEST(FalseInvariants, OfAContactAreRefutedOnItsOtherSide) {
  for (const char* scheme : {"", "gauss-4", "rk4", "yoshida-4", "stormer-verlet"})
    EXPECT_EQ(verdict_of(model(kContact), {.scheme = scheme}, "P invariant"), Verdict::refuted)
        << scheme;
  EXPECT_THROW((void)generate(model(kContact), {.require = "conserves:P"}), ProofError);
  EXPECT_THROW((void)generate(model(kContact), {.require = "symplectic"}), ProofError);
  const std::string header = generate(model(kContact), {}).front().text;
  EXPECT_EQ(header.find("conserves P"), std::string::npos);
}

TEST(FalseInvariants, BeyondTheFirstPointsAreRefutedToo) {
  for (const char* root : {"abs(x)", "sqrt(x^2)"}) {
    const SourceText source =
        model("coordinate x, y\nmomentum u, v\nH = (u^2 + v^2 + x^2 + y^2)/2 + (" +
              std::string(root) + " - x)^3\ninvariant L = x*v - y*u\n");
    EXPECT_EQ(verdict_of(source, {}, "L invariant"), Verdict::refuted) << root;
  }
  EXPECT_EQ(
      verdict_of(of_one("p^2/2 + (q - 2 + abs(q - 2))^2", "invariant P = p\n"), {}, "P invariant"),
      Verdict::refuted);
  for (const char* invariant : {"(abs(q) - q)*p", "sqrt(q^2)*p - q*p"}) {
    EXPECT_EQ(verdict_of(of_one("p^2/2 + q^2/2", "invariant I = " + std::string(invariant) + "\n"),
                         {}, "I invariant"),
              Verdict::refuted)
        << invariant;
  }
}

// Two hydrogen atoms in SI units, and an invariant in units that are too large.
TEST(FalseInvariants, AreNotZeroBecauseTheyAreSmall) {
  EXPECT_EQ(verdict_of(of_one("p^2/2 + q^2/2", "invariant B = 1e-31*q\n"), {}, "B invariant"),
            Verdict::refuted);
  EXPECT_EQ(
      verdict_of(of_one("p^2/(2*1.67e-27) - 1.87e-64/q", "invariant P = p\n"), {}, "P invariant"),
      Verdict::refuted);
  // Beside terms of size 1 that cancel.
  const SourceText beside = model(
      "coordinate x, y\nmomentum u, v\nH = (u^2 + v^2)/2 - cos(x - y)\n"
      "invariant P = u + v + 1e-31*x\n");
  EXPECT_EQ(verdict_of(beside, {}, "P invariant"), Verdict::refuted);
}

// {I, H} = 0 off the corner, and jumps by 2 and by pi across it.
TEST(FalseInvariants, ThatJumpAreNeverProved) {
  for (const char* invariant : {"q/abs(q)", "atan2(q, p) - atan(q/p)", "sqrt(q^2)/q"}) {
    const SourceText source =
        of_one("p^2/2 + q^2/2", "invariant I = " + std::string(invariant) + "\n");
    const Finding found = finding(source, {}, "I invariant");
    EXPECT_EQ(found.verdict, Verdict::tested) << found.detail;
    EXPECT_NE(found.detail.find("off the corners of "), std::string::npos) << found.detail;
    EXPECT_NE(verdict_of(source, {}, "I conserved by the step"), Verdict::proved);
  }
}

TEST(TrueClaims, AreDecidedWhereTheModelIsDefined) {
  const auto scene = [](const std::string& q) {
    return "scene s { q = " + q + "; h = 0.01; steps = 10 }\n";
  };
  EXPECT_EQ(verdict_of(of_one("p^2/2 + sqrt(q - 2)^3", scene("3")), {}, "program"),
            Verdict::proved);
  EXPECT_EQ(verdict_of(of_one("p^2/2 + log(q - 5)", scene("6")), {}, "program"), Verdict::proved);
  EXPECT_EQ(verdict_of(of_one("p^2/2 + sqrt(-q)", scene("-3")), {}, "program"), Verdict::proved);
  EXPECT_EQ(verdict_of(of_one("p^2/2 + acos(q - 3)", scene("3")), {}, "program"), Verdict::proved);
  // By points alone, of what is defined near the scene only.
  const SourceText narrow =
      of_one("p^2/2 + log(q - 500)",
             "invariant I = p^2/2 + log(q - 500) + sin(2*q) - 2*sin(q)*cos(q)\n" + scene("501"));
  EXPECT_EQ(verdict_of(narrow, {}, "I invariant"), Verdict::tested);
  EXPECT_EQ(verdict_of(narrow, {}, "I conserved by the step"), Verdict::not_decided);
}

TEST(TrueClaims, AboutKeplersProblemNeedNoCorner) {
  const SourceText kepler = read_source(HAMGEN_SOURCE_DIR "/hamiltonians/kepler.ham");
  EXPECT_TRUE(corners_of_hamiltonian(kepler, {}).empty());
  EXPECT_EQ(verdict_of(kepler, {}, "L conserved by the step"), Verdict::proved);
}

const std::string kQuartic =
    "coordinate q\nmomentum p\nparameter a = -1\nH = p^2/2 + a^2*q^2/2 + q^4/4\n"
    "scene s { q = 1; h = 0.1; steps = 100 }\n";

TEST(FalseGauges, OfAParameterWithTheOtherSignAreRefuted) {
  for (const char* size : {"abs(a)", "sqrt(a^2)"}) {
    const Request outside{.gauge = "[[(" + std::string(size) + " - a)/7, 0], [0, 0]]"};
    for (const char* property : {"gauge in sp(2n)", "symplectic", "symmetric"})
      EXPECT_EQ(verdict_of(model(kQuartic), outside, property), Verdict::refuted) << property;
    EXPECT_EQ(verdict_of(model(kQuartic), {.beta = std::string(size) + " - a"}, "symmetric"),
              Verdict::refuted);
  }
}

TEST(FalseOrders, OfACoefficientThatVanishesAreNotClaimed) {
  // C(0) = 0, which takes points to see: no leading error of order 1.
  const Request hidden{.beta = "sin(a)^2 + cos(a)^2 - 1"};
  EXPECT_EQ(verdict_of(model(kQuartic), hidden, "order 1"), Verdict::measured) << "must be missing";
  EXPECT_EQ(verdict_of(model(kQuartic), hidden, "order 2"), Verdict::tested);
}

TEST(FalseOrders, OfAWrongKAreRefutedWithIt) {
  const SourceText pendulum = read_source(HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham");
  EXPECT_EQ(verdict_of(pendulum, {.order = 4}, "order 4"), Verdict::tested);
  GeneratingFunction k;
  k.order = 4;
  EXPECT_EQ(prove_raised_order(k, {.verdict = Verdict::refuted, .witness = "here"}).verdict,
            Verdict::refuted);
  EXPECT_EQ(prove_raised_order(k, {}).verdict, Verdict::not_decided);
}

// The nodes of a Gauss method are enclosed in exact rationals; a digit less is another method.
TEST(FalseOrders, OfGaussNeedTheZerosOfTheLegendrePolynomial) {
  Scheme scheme = *find_scheme("gauss-8");
  auto tableau = std::get<RungeKutta>(scheme.method);
  EXPECT_EQ(prove_tableau(tableau, 8)[0].verdict, Verdict::proved);
  EXPECT_EQ(prove_tableau(tableau, 8)[2].property, "order 8");
  tableau.a[1][0] += Expression(*parse_decimal("1e-33"));
  for (const Finding& f : prove_tableau(tableau, 8))
    EXPECT_NE(f.verdict, Verdict::proved) << f.property;
}

TEST(FalseSymmetry, IsNotFoundInAZeroThatIsASmallNumber) {
  const Request gauge{.gauge = "[[h/3, h/5], [h/7, -h/3 + 1e-60]]"};
  EXPECT_EQ(verdict_of(of_one("p^2/2 - cos(q)"), gauge, "symmetric"), Verdict::refuted);
}

TEST(FalseSymmetry, IsNotFoundInAHiddenZero) {
  // Odd in h, which algebra does not see.
  const SourceText pendulum = read_source(HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham");
  const std::string odd = "log((1 + h)/(1 - h))";
  EXPECT_EQ(verdict_of(pendulum, {.beta = odd}, "symmetric"), Verdict::tested);
  EXPECT_EQ(verdict_of(pendulum, {.scheme = "yoshida-4", .beta = odd}, "symmetric"),
            Verdict::tested);
  EXPECT_EQ(verdict_of(pendulum, {.scheme = "yoshida-4", .beta = odd}, "order 4"), Verdict::tested);
  EXPECT_THROW((void)verify_step(pendulum, {.scheme = "yoshida-4", .beta = "h^2"}), UsageError);
}

TEST(Sweeps, AreJudgedByWhatTheySolve) {
  // h = 500 makes of 1e-6 what is no rounding.
  const SourceText weak = of_one("p^2/2 - 1e-6*cos(q)", "scene s { q = 2; h = 500; steps = 10 }\n");
  EXPECT_EQ(verdict_of(weak, {.solver = "sweeps:8"}, "symplectic"), Verdict::refuted);
  EXPECT_EQ(verdict_of(weak, {.solver = "sweeps:8"}, "symmetric"), Verdict::refuted);
  // The exact flow.
  EXPECT_EQ(verdict_of(of_one("p^2/2"), {.solver = "sweeps:2"}, "symplectic"), Verdict::proved);
  EXPECT_EQ(verdict_of(of_one("p^2/2"), {.solver = "sweeps:2"}, "symmetric"), Verdict::proved);
  // zbar depends on itself by pattern, and not by algebra: p - q is constant.
  const SourceText nilpotent = of_one("(p - q)^2/2 + (p - q)^4");
  EXPECT_EQ(verdict_of(nilpotent, {.solver = "sweeps:2"}, "symplectic"), Verdict::proved);
  // u needs y, x needs u: one sweep is one too few.
  const SourceText chain = model("coordinate x, y\nmomentum u, v\nH = u^2/2 + x*y\n");
  EXPECT_NE(verdict_of(chain, {.solver = "sweeps:1"}, "symplectic"), Verdict::proved);
  EXPECT_EQ(verdict_of(chain, {.solver = "sweeps:2"}, "symplectic"), Verdict::proved);
}

// A composition is as far from symplectic as its substeps.
TEST(Sweeps, OfACompositionAreJudgedByWhatTheySolve) {
  for (const char* scheme : {"yoshida-4", "suzuki-4", "kahan-li-8"}) {
    const Request swept{.scheme = scheme, .solver = "sweeps:1"};
    const Finding symplectic = finding(of_one("p^2/2 - cos(q)"), swept, "symplectic");
    EXPECT_EQ(symplectic.verdict, Verdict::refuted) << scheme;
    EXPECT_NE(symplectic.detail.find("by its power series"), std::string::npos)
        << symplectic.detail;
    EXPECT_EQ(verdict_of(of_one("p^2/2 - cos(q)"), swept, "symmetric"), Verdict::refuted);
    EXPECT_THROW((void)generate(of_one("p^2/2 - cos(q)"),
                                {.scheme = scheme, .solver = "sweeps:1", .require = "symplectic"}),
                 ProofError);
  }
  const SourceText chain = model(
      "size N = 26\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2 - cos(q[i+1] - q[i]))\n");
  EXPECT_EQ(verdict_of(chain, {.scheme = "yoshida-4", .solver = "sweeps:1"}, "symplectic"),
            Verdict::not_decided);
}

// Coordinates in metres of what is 1e-10 metres long, and in units that are far too small.
TEST(TrueOrders, AreFoundInUnitsOfAnySize) {
  const SourceText small = model(
      "coordinate x, y\nmomentum u, v\nH = (u^2 + v^2)/2 - 1e-10/sqrt(x^2 + y^2)\n"
      "scene s { x = 1e-10; y = 3e-11; v = 0.8; h = 1e-12; steps = 10 }\n");
  const SourceText large = model(
      "coordinate q\nmomentum p\nH = p^2/2 + q^4/4\n"
      "scene s { q = 1e100; p = -3e199; h = 1e-102; steps = 10 }\n");
  for (const SourceText& source : {small, large}) {
    const Proof proof = verify_step(source, {.order = 4});
    EXPECT_EQ(finding_of(proof, "order 4").verdict, Verdict::tested);
    EXPECT_EQ(finding_of(proof, "program").verdict, Verdict::tested);
    EXPECT_NE(finding(source, {.solver = "sweeps:2"}, "symplectic").detail.find("`O(h^4)`, by"),
              std::string::npos);
  }
  // Of so many periods no digits tell the last one.
  const SourceText periods = model(
      "coordinate q\nmomentum p\nH = p^2/2 + q^4/4 + cos(q*p)/10\n"
      "scene s { q = 1e50; p = -3e99; h = 1e-52; steps = 10 }\n");
  EXPECT_EQ(verdict_of(periods, {.order = 4}, "program"), Verdict::tested);
}

TEST(Corners, AreNotWhereASecondArgumentIsPositive) {
  const auto of = [](const std::string& second) {
    return verdict_of(
        model("coordinate q, r\nmomentum p, s\nH = (p^2 + s^2)/2 + atan2(q, " + second + ")^2\n"),
        {}, "symplectic");
  };
  EXPECT_EQ(of("1 + r^2"), Verdict::proved);
  EXPECT_EQ(of("exp(r)"), Verdict::proved);
  for (const char* second : {"1 + r", "r^2 - 1", "r^3 + 1", "r^2"})
    EXPECT_EQ(of(second), Verdict::tested) << second;
}

TEST(Corners, LowerEveryVerdictOfTheStepAndAreNamed) {
  const SourceText source = of_one("abs(p) + abs(q)");
  for (const Finding& f : verify_step(source, {})) {
    if (f.property == "gauge in sp(2n)") continue;
    EXPECT_EQ(f.verdict, Verdict::tested) << f.property;
    // The texts rest on the program, and the reading of the model on points.
    if (f.property == "emitted code" || f.property == "plugin" || f.property == "model") continue;
    EXPECT_NE(f.detail.find("off the corners of abs("), std::string::npos) << f.detail;
  }
  const auto found = corners_of_hamiltonian(source, {});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].place, "q = 0");
}

TEST(Corners, AreFoundInRootsOfSquaresAndNotInOtherRoots) {
  const auto count = [](const std::string& h) {
    return corners_of_hamiltonian(of_one(h), {}).size();
  };
  EXPECT_EQ(count("sqrt(q^2) + p^2"), 1U);
  EXPECT_EQ(count("sqrt(q^2 - 2*q + 1) + p^2"), 1U);
  EXPECT_EQ(count("sqrt(q^2*p^2 + 2*q*p + 1)"), 1U);
  EXPECT_EQ(count("(q^2)^(3/2) + p^2"), 1U);
  EXPECT_EQ(count("sqrt(sin(q)^2) + p^2"), 1U);
  EXPECT_EQ(count("atan2(q, p)"), 1U);
  EXPECT_EQ(count("sqrt((q^2 + 1)/(p^2 - 2*p + 1))"), 1U);
  EXPECT_EQ(count("q/abs(q)*p"), 1U);
  EXPECT_EQ(count("sqrt(q^4) + p^2"), 0U);
  EXPECT_EQ(count("sqrt(q^2 + p^2)"), 0U);
  EXPECT_EQ(count("(q^2 - 2*q + 1)^2 + p^2"), 0U);
  EXPECT_EQ(count("sqrt(1 + q^2) + p^2"), 0U);
  // What is too long to be looked at has none that are known.
  EXPECT_EQ(count("sqrt((q^3 + p + 1)^60 + q) + p^2"), 0U);
}

// abs(x) taken for x in the instructions agrees with H on half of the line.
TEST(FalseCode, IsRefutedOnTheOtherSideOfACorner) {
  Identities wrong;
  const Expression q = Expression::symbol("q");
  const Expression size = Expression::apply("abs", {q});
  wrong.claims.push_back({"the energy", q * q * q, size * q * q});
  EXPECT_EQ(decide(wrong).verdict, Verdict::refuted);
}

// The bond angle of three atoms with a root of a product: expanded, the entries of its Hessian have
// millions of terms.  They are looked at at points.
TEST(ProofOfACodesAlgebra, IsGivenUpWhereItWouldNotEnd) {
  const auto source = [](const std::string& root) {
    return model(R"(coordinate x[1..3], y[1..3], z[1..3]
momentum px[1..3], py[1..3], pz[1..3]
let a = (x[2]-x[1])*(x[3]-x[2]) + (y[2]-y[1])*(y[3]-y[2]) + (z[2]-z[1])*(z[3]-z[2])
let b = (x[2]-x[1])^2 + (y[2]-y[1])^2 + (z[2]-z[1])^2
let c = (x[3]-x[2])^2 + (y[3]-y[2])^2 + (z[3]-z[2])^2
H = sum(i=1..3, px[i]^2 + py[i]^2 + pz[i]^2)/2 + 50*(a/)" +
                 root + " - 0.3)^2\n");
  };
  EXPECT_EQ(finding(source("sqrt(b*c)"), {}, kProgram).verdict, Verdict::tested);
  EXPECT_EQ(finding(source("(sqrt(b)*sqrt(c))"), {}, kProgram).verdict, Verdict::proved);
}

void expect_tangent(const std::string& model) {
  const SourceText source = read_source(HAMGEN_SOURCE_DIR "/hamiltonians/" + model);
  const Finding program = finding(source, {.tangent = true}, kProgram);
  EXPECT_TRUE(holds(program.verdict)) << model << ": " << program.detail;
}

// A parameter m[0] is not an element of the matrix m, and where 60 digits cancel another point
// tells.
TEST(Tangent, IsTheLinearisedStepWhateverTheModelsNamesAndPoints) {
  for (const char* model : {"toda.ham", "pythagorean.ham", "kepler.ham"}) expect_tangent(model);
}
TEST(Tangent, OfEveryShippedModelIsTheLinearisedStep) {
  int found = 0;
  for (const auto& file : std::filesystem::directory_iterator(HAMGEN_SOURCE_DIR "/hamiltonians")) {
    if (file.path().extension() != ".ham") continue;
    expect_tangent(file.path().filename().string());
    ++found;
  }
  EXPECT_GE(found, 20);
}

TEST(PreciseValues, TellLostDigitsFromAPole) {
  const Expression x = Expression::symbol("x", 0);
  const Expression y = Expression::symbol("y", 1);
  const Substitution none;
  PreciseValues cancelled({{"x", precise(Rational(1, 3))}, {"y", precise(Rational(1, 3))}}, none);
  EXPECT_FALSE(cancelled(Expression(1) / (x - y)));
  EXPECT_TRUE(cancelled.has_lost_digits());
  PreciseValues at_pole({{"x", precise(0)}, {"y", precise(1)}}, none);
  EXPECT_FALSE(at_pole(y / x));
  EXPECT_FALSE(at_pole.has_lost_digits());
}

}  // namespace
}  // namespace hamgen
