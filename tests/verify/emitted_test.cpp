// The proof that the emitted code is the mathematics: it holds for what is emitted, and notices
// what is not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/verify/proof.hpp"
#include "tests/verify/evaluator.hpp"
#include "tests/verify/mutants.hpp"

namespace hamgen {
namespace {

using verify_test::computes_the_same;
using verify_test::lowered_of;
using verify_test::mutants_of;
using verify_test::mutants_of_structure;

struct Case {
  std::string name;
  std::string text;  // of the model, without its first line
  std::string solver;
  Expression alpha, beta, gamma;
};

Expression half() { return Expression(Rational(1, 2)); }
Expression number(long over, long under) { return Expression(Rational(over, under)); }

Scheme scheme_of(const Case& c, int n) {
  return family_member(n, {{c.alpha}}, {{c.beta}}, {{c.gamma}});
}

Mechanics mechanics_of(const Case& c) { return verify_test::mechanics_of(c.text); }

const std::string kPendulum =
    "coordinate q\nmomentum p\nparameter eps = 0.03\nH = p^2/2 - eps*cos(q)\n";
const std::string kHenonHeiles =
    "coordinate q1, q2\nmomentum p1, p2\n"
    "H = (p1^2 + p2^2)/2 + (q1^2 + q2^2)/2 + q1^2*q2 - q2^3/3\ninvariant Q = q1*p2\n";
const std::string kKepler =
    "coordinate x, y\nmomentum px, py\nparameter mu = 1\nH = (px^2 + py^2)/2 - mu/sqrt(x^2 + "
    "y^2)\n";
const std::string kProduct = "coordinate q\nmomentum p\nH = (q^2 + 1)*(p^2 + 1)/2\n";
const std::string kSpring = "coordinate q\nmomentum p\nparameter w = 2\nH = p^2/2 + w^2*q^2/2\n";
const std::string kMagnetic =
    "coordinate x, y\nmomentum px, py\nparameter B = 1\n"
    "H = (px + B*y/2)^2/2 + (py - B*x/2)^2/2 + x^2*y^2\n";
const std::string kSuccessive =
    "coordinate q1, q2\nmomentum p1, p2\nH = q1*p1^3/3 + q2*p1*p2 + q1^2 + p1*p2^2\n";
const std::string kRing =
    "size N = 5\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
    "H = sum(i = 1..N, p[i]^2/2 + (q[i+1] - q[i])^4/4 + q[i]^2/2)\n";

Finding prove(const Mechanics& mechanics, const Scheme& scheme, const LoweredStep& lowered,
              const Program& code) {
  return prove_emitted(mechanics, scheme, lowered.plan, code, mechanics.energy);
}
Finding prove(const Mechanics& mechanics, const Scheme& scheme, const LoweredStep& lowered) {
  return prove(mechanics, scheme, lowered, build_program(lowered));
}

std::vector<Case> cases() {
  const Expression h = Expression::symbol("h", kRankOfStep);
  const Expression zero(0);
  return {
      {"explicit", kPendulum, "", zero, zero, zero},
      {"explicit, two degrees of freedom", kHenonHeiles, "", Expression(1), zero, zero},
      {"Newton of size 1", kPendulum, "", half(), number(1, 10) * h, number(-1, 12) * h},
      {"Newton of size 2", kHenonHeiles, "", half(), zero, zero},
      {"Newton of size 2 with roots", kKepler, "", number(2, 5), zero, zero},
      {"Newton of size 2, nothing torn", kProduct, "", half(), number(1, 5), number(1, 7)},
      {"dense Newton", kRing, "", half(), zero, zero},
      {"dense Newton, full gauge", kMagnetic, "", number(1, 3), number(1, 5), number(1, 7)},
      {"linear", kSpring, "", half(), zero, zero},
      {"quadratic", kProduct, "", zero, zero, zero},
      {"Newton, then linear", kSuccessive, "", zero, zero, zero},
      {"quadratic in q", kProduct, "", Expression(1), zero, zero},
      {"fixed point", kHenonHeiles, "fixed-point", half(), zero, zero},
      {"sweeps", kKepler, "sweeps:3", half(), number(1, 9), zero},
  };
}

TEST(EmittedCode, IsTheMathematicsForEverySolver) {
  for (const Case& c : cases()) {
    const Mechanics mechanics = mechanics_of(c);
    const Scheme scheme = scheme_of(c, mechanics.degrees_of_freedom);
    const LoweredStep lowered = lowered_of(mechanics, scheme, c.solver);
    const Finding finding = prove(mechanics, scheme, lowered);
    EXPECT_EQ(finding.verdict, Verdict::proved) << c.name << ": " << finding.detail;
  }
}

// dH/de = 1: the weight times h dH/de, which is rounded, is a factor of the other rows, too.
TEST(EmittedCode, MayHoldAProductBothRoundedAndExact) {
  const Case c{"clock",
               "coordinate q, s\nmomentum p, e\nH = p^2/2 + (1 + s)*q^2/2 + e\n",
               "",
               number(3, 10),
               Expression(0),
               Expression(0)};
  const Mechanics mechanics = mechanics_of(c);
  const Scheme scheme = scheme_of(c, mechanics.degrees_of_freedom);
  const LoweredStep lowered = lowered_of(mechanics, scheme, c.solver);
  const Finding finding = prove(mechanics, scheme, lowered);
  EXPECT_EQ(finding.verdict, Verdict::proved) << finding.detail;
}

// A mutation may cancel, such as the sign of a factor that is squared later, or matter to rounding
// alone, as where an affine block starts: those that compute the same must pass, by algebra or at
// points, all others be refuted.
TEST(EmittedCode, EveryMutationOfAProgramIsRefuted) {
  int mutants = 0;
  int equivalent = 0;
  std::size_t first = 0;
  std::map<std::string, int> by_kind;
  for (const Case& c : cases()) {
    const Mechanics mechanics = mechanics_of(c);
    const Scheme scheme = scheme_of(c, mechanics.degrees_of_freedom);
    const LoweredStep original = lowered_of(mechanics, scheme, c.solver);
    int of_case = 0;
    const Program code = build_program(original);
    std::vector<verify_test::Mutant> list = mutants_of(code, {3, first});
    std::ranges::move(mutants_of_structure(code, {3, first++}), std::back_inserter(list));
    for (const verify_test::Mutant& mutant : list) {
      const Finding finding = prove(mechanics, scheme, original, mutant.code);
      if (computes_the_same(code, mutant.code)) {
        // What a torn value is off is made up for, and may be large: the step is the same, its
        // rounding is not.
        const bool is_made_up_for = finding.detail.starts_with("the stage value of ");
        EXPECT_TRUE(is_made_up_for || finding.verdict != Verdict::refuted)
            << c.name << ", " << mutant.kind << ": " << mutant.description << "\n"
            << finding.detail;
        ++equivalent;
        continue;
      }
      EXPECT_EQ(finding.verdict, Verdict::refuted)
          << c.name << ", " << mutant.kind << ": " << mutant.description << "\n"
          << finding.detail;
      ++mutants;
      ++of_case;
      ++by_kind[mutant.kind];
    }
    EXPECT_GE(of_case, 3) << c.name;
  }
  RecordProperty("mutants", mutants);
  std::string counts;
  for (const auto& [name, count] : by_kind) counts += fmt::format(", {} {}", count, name);
  fmt::print("{} mutants{}; {} others compute the same\n", mutants, counts, equivalent);
  EXPECT_GE(mutants, 150);
  EXPECT_GE(by_kind.size(), 6U);
}

// Of masses that differ the matrix is not symmetric, whatever the program says of it.
TEST(EmittedCode, AMatrixIsSymmetricOnlyIfItIs) {
  const auto verdict = [](const std::string& kinetic, bool claimed) {
    const std::string text =
        "size N = 5\ncoordinate q[1..N] periodic\nmomentum p[1..N]\nH = sum(i = 1..N, " + kinetic +
        " + (q[i+1] - q[i])^4/4 + q[i]^2/2)\n";
    const Case c{"ring", text, "newton", half(), Expression(0), Expression(0)};
    const Mechanics mechanics = mechanics_of(c);
    const Scheme scheme = scheme_of(c, mechanics.degrees_of_freedom);
    const LoweredStep lowered = lowered_of(mechanics, scheme, c.solver);
    Program code = build_program(lowered);
    const auto solve = std::ranges::find(code.routines, "solve", &Routine::name);
    int matrices = 0;
    for (Instruction& outer : solve->body) {
      auto* iterate = std::get_if<Iterate>(&outer.value);
      if (iterate == nullptr) continue;
      for (Instruction& inner : iterate->body) {
        auto* matrix = std::get_if<Matrix>(&inner.value);
        if (matrix == nullptr) continue;
        ++matrices;
        EXPECT_EQ(matrix->symmetric, kinetic == "p[i]^2/2");
        matrix->symmetric |= claimed;
      }
    }
    EXPECT_EQ(matrices, 1);
    return prove_emitted(mechanics, scheme, lowered.plan, code, mechanics.energy).verdict;
  };
  EXPECT_EQ(verdict("p[i]^2/2", false), Verdict::proved);
  EXPECT_EQ(verdict("i*p[i]^2/2", false), Verdict::proved);
  EXPECT_EQ(verdict("i*p[i]^2/2", true), Verdict::refuted);
}

TEST(EmittedCode, ParametersOfTheFamilyMayNotBeExchanged) {
  for (const Case& c : cases()) {
    const Mechanics mechanics = mechanics_of(c);
    const int n = mechanics.degrees_of_freedom;
    const Case straight{c.name, c.text, c.solver, number(1, 3), number(1, 5), number(1, 7)};
    Case swapped = straight;
    std::swap(swapped.beta, swapped.gamma);
    const LoweredStep lowered = lowered_of(mechanics, scheme_of(swapped, n), c.solver);
    EXPECT_EQ(prove(mechanics, scheme_of(swapped, n), lowered).verdict, Verdict::proved) << c.name;
    EXPECT_EQ(prove(mechanics, scheme_of(straight, n), lowered).verdict, Verdict::refuted)
        << c.name;
  }
}

// The derivatives are derived anew from H: a wrong one in the mechanics does not pass.
TEST(EmittedCode, WrongDerivativesOfTheMechanicsAreRefuted) {
  for (const Case& c : cases()) {
    Mechanics wrong = mechanics_of(c);
    wrong.gradient[0] = wrong.gradient[0] * Expression(2);
    const Scheme scheme = scheme_of(c, wrong.degrees_of_freedom);
    const LoweredStep first = lowered_of(wrong, scheme, c.solver);
    EXPECT_EQ(prove(wrong, scheme, first).verdict, Verdict::refuted) << c.name;
    if (c.solver != "" || c.alpha.is_zero() || c.alpha.is_one()) continue;  // no Hessian in them
    wrong = mechanics_of(c);
    Expression& entry = wrong.hessian.begin()->second;
    entry = entry * Expression(2);
    const LoweredStep second = lowered_of(wrong, scheme, c.solver);
    EXPECT_EQ(prove(wrong, scheme, second).verdict, Verdict::refuted) << c.name;
  }
}

// A system whose sums stay loops, by every method.
struct Loops {
  std::string name;
  std::string solver;
  std::optional<Scheme> scheme;
};

const std::string kChain =
    "size N = 26\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
    "parameter k = 1\nparameter m[1..N] = 2\n"
    "H = sum(i = 1..N, p[i]^2/(2*m[i])) + sum(i = 0..N, k*(q[i+1] - q[i])^4/4)\n";
const std::string kCoupledRing =
    "size N = 25\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
    "H = sum(i = 1..N, p[i]^2/2 + p[i]*q[i]*q[i+1] + (q[i+1] - q[i])^4/4)\n";

// Linear equations, with the momenta torn out and without.
const std::string kSprings =
    "size N = 25\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
    "parameter k = 1\nparameter m[1..N] = 2\n"
    "H = sum(i = 1..N, p[i]^2/(2*m[i])) + sum(i = 0..N, k*(q[i+1] - q[i])^2/2)\n";
const std::string kTurningSprings =
    "size N = 25\ncoordinate q[1..N] periodic\nmomentum p[1..N]\nparameter b = 1\n"
    "H = sum(i = 1..N, p[i]^2/2 + b*p[i]*q[i+1] + q[i]^2/3)\n";

const std::string kRotators =
    "size N = 25\ncoordinate q[1..N]\nmomentum p[1..N]\nparameter K = 1\n"
    "let C = sum(i = 1..N, cos(q[i]))\nlet S = sum(i = 1..N, sin(q[i]))\n"
    "H = sum(i = 1..N, p[i]^2/2) - K*(C^2 + S^2)/(2*N) + sqrt(1 + sum(i = 1..N, p[i])^2)\n";

Scheme uniform(int n, const Expression& alpha, const Expression& beta, const Expression& gamma) {
  return family_member(n, {{alpha}}, {{beta}}, {{gamma}});
}

std::vector<Loops> loops(const Mechanics& mechanics) {
  const int n = mechanics.degrees_of_freedom;
  const Expression zero(0);
  const auto named = [&](const char* name) { return for_system(*find_scheme(name), mechanics); };
  std::vector<Loops> all = {
      {"Newton", "", uniform(n, half(), zero, zero)},
      {"Newton, full gauge", "", uniform(n, number(1, 3), number(1, 5), number(1, 7))},
      {"fixed point", "fixed-point", uniform(n, half(), zero, zero)},
      {"sweeps", "sweeps:2", uniform(n, number(2, 5), number(1, 9), zero)},
      {"rk4", "", named("rk4")},
      {"gauss-2", "fixed-point", named("gauss-2")},
  };
  if (!mechanics.is_separable()) return all;
  all.push_back({"explicit", "", uniform(n, zero, zero, zero)});
  all.push_back({"explicit, the other way", "", uniform(n, Expression(1), zero, zero)});
  all.push_back({"splitting", "", named("stormer-verlet")});
  all.push_back({"splitting of three kicks", "", named("ruth-3")});
  all.push_back({"splitting of three drifts", "", named("saba-2")});
  all.push_back(
      {"composition", "", compose(*find_scheme("yoshida-4"), uniform(n, half(), zero, zero))});
  return all;
}

struct LoopsUnderTest {
  Mechanics mechanics;
  Expression hamiltonian;
};
LoopsUnderTest loops_of(const std::string& text) {
  const Model model = read_model(make_source("loops.ham", "system loops\n" + text));
  return {derive(model), written_out_hamiltonian(model)};
}

TEST(EmittedLoops, AreTheMathematics) {
  for (const std::string& text : {kChain, kCoupledRing, kRotators}) {
    const auto [mechanics, hamiltonian] = loops_of(text);
    ASSERT_TRUE(mechanics.keeps_sums());
    for (const Loops& c : loops(mechanics)) {
      const LoweredStep lowered = lowered_of(mechanics, *c.scheme, c.solver);
      const Finding finding =
          prove_emitted(mechanics, *c.scheme, lowered.plan, build_program(lowered), hamiltonian);
      EXPECT_TRUE(holds(finding.verdict)) << c.name << ": " << finding.detail;
      EXPECT_TRUE(finding.verdict == Verdict::proved || !mechanics.sums.empty()) << c.name;
    }
  }
}

int refuted_mutants(const std::vector<std::string>& texts) {
  int mutants = 0;
  std::size_t first = 0;
  for (const std::string& text : texts) {
    const auto [mechanics, hamiltonian] = loops_of(text);
    for (const Loops& c : loops(mechanics)) {
      const LoweredStep lowered = lowered_of(mechanics, *c.scheme, c.solver);
      const Program code = build_program(lowered);
      // Some of each, for a proof takes long here.
      std::vector<verify_test::Mutant> list = mutants_of_structure(code, {13, first});
      std::ranges::move(mutants_of(code, {47, first++}), std::back_inserter(list));
      for (const verify_test::Mutant& mutant : list) {
        if (computes_the_same(code, mutant.code)) continue;
        const Finding finding =
            prove_emitted(mechanics, *c.scheme, lowered.plan, mutant.code, hamiltonian);
        EXPECT_EQ(finding.verdict, Verdict::refuted)
            << c.name << ", " << mutant.kind << ": " << mutant.description << "\n"
            << finding.detail;
        ++mutants;
      }
    }
  }
  fmt::print("{} mutants of loops\n", mutants);
  return mutants;
}

TEST(EmittedLoops, EveryMutationIsRefuted) {
  EXPECT_GE(refuted_mutants({kChain, kCoupledRing}), 20);
}

TEST(EmittedLoops, LinearEquationsAreTheMathematicsAndNoMutantIs) {
  int mutants = 0;
  for (const std::string& text : {kSprings, kTurningSprings}) {
    const auto [mechanics, hamiltonian] = loops_of(text);
    for (const Loops& c : loops(mechanics)) {
      if (!c.name.starts_with("Newton")) continue;
      const LoweredStep lowered = lowered_of(mechanics, *c.scheme, c.solver);
      const Program code = build_program(lowered);
      ASSERT_NE(code.routine("gradient_error"), nullptr) << c.name;
      const Finding right = prove_emitted(mechanics, *c.scheme, lowered.plan, code, hamiltonian);
      EXPECT_EQ(right.verdict, Verdict::proved) << c.name << ": " << right.detail;
      std::vector<verify_test::Mutant> list =
          mutants_of(code, {5, 0}, {"gradient_error", "curvature"});
      std::ranges::move(mutants_of(code, {11, 1}, {"solve"}), std::back_inserter(list));
      for (const verify_test::Mutant& mutant : list) {
        if (computes_the_same(code, mutant.code)) continue;
        const Finding finding =
            prove_emitted(mechanics, *c.scheme, lowered.plan, mutant.code, hamiltonian);
        EXPECT_EQ(finding.verdict, Verdict::refuted)
            << c.name << ", " << mutant.kind << ": " << mutant.description << "\n"
            << finding.detail;
        ++mutants;
      }
    }
  }
  EXPECT_GE(mutants, 20);
}

// Of the K that stands in for H, too.
TEST(EmittedLoops, OfARaisedMemberAreTheMathematicsAndNoMutantIs) {
  const auto [mechanics, hamiltonian] = loops_of(
      "size N = 25\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^3/3)\n");
  const int n = mechanics.degrees_of_freedom;
  const Scheme scheme = raise_order(uniform(n, half(), Expression(0), Expression(0)), 4);
  const LoweredStep lowered = lowered_of(mechanics, scheme, "");
  const Program code = build_program(lowered);
  const Finding finding = prove_emitted(mechanics, scheme, lowered.plan, code, hamiltonian);
  EXPECT_EQ(finding.verdict, Verdict::tested) << finding.detail;
  std::vector<verify_test::Mutant> list =
      mutants_of(code, {11, 0}, {"generating_gradient", "differentiate"});
  std::ranges::move(mutants_of(code, {11, 1}, {"solve"}), std::back_inserter(list));
  int mutants = 0;
  for (const verify_test::Mutant& mutant : list) {
    if (computes_the_same(code, mutant.code)) continue;
    EXPECT_EQ(prove_emitted(mechanics, scheme, lowered.plan, mutant.code, hamiltonian).verdict,
              Verdict::refuted)
        << mutant.kind << ": " << mutant.description;
    ++mutants;
  }
  EXPECT_GE(mutants, 3);
}

TEST(EmittedLoops, EveryMutationOfAFunctionOfSumsIsRefuted) {
  EXPECT_GE(refuted_mutants({kRotators}), 5);
}

// Of a separable system the step calls the two halves: the whole is for who uses the header.
TEST(EmittedLoops, AGradientThatNoStepCallsIsProvedToo) {
  const auto [mechanics, hamiltonian] = loops_of(kChain);
  for (const Loops& c : loops(mechanics)) {
    const LoweredStep lowered = lowered_of(mechanics, *c.scheme, c.solver);
    for (const std::size_t dropped : {0, 1}) {
      Program code = build_program(lowered);
      const auto gradient = std::ranges::find(code.routines, "gradient", &Routine::name);
      ASSERT_NE(gradient, code.routines.end()) << c.name;
      ASSERT_EQ(gradient->body.size(), 2u) << c.name;
      gradient->body.erase(gradient->body.begin() + static_cast<std::ptrdiff_t>(dropped));
      EXPECT_EQ(prove_emitted(mechanics, *c.scheme, lowered.plan, code, hamiltonian).verdict,
                Verdict::refuted)
          << c.name << ", without call " << dropped;
    }
  }
}

// The derivatives are derived anew from H, for loops too.
TEST(EmittedLoops, WrongKernelsAreRefuted) {
  const auto [mechanics, hamiltonian] = loops_of(kChain);
  const Scheme scheme = uniform(mechanics.degrees_of_freedom, half(), Expression(0), Expression(0));
  const auto verdict = [&](const Mechanics& wrong) {
    const LoweredStep lowered = lowered_of(wrong, scheme, "");
    return prove_emitted(wrong, scheme, lowered.plan, build_program(lowered), hamiltonian).verdict;
  };
  Mechanics slope = mechanics;
  slope.kernels.back().gradient.front() += Expression(1);
  EXPECT_EQ(verdict(slope), Verdict::refuted);
  Mechanics second = mechanics;
  second.kernels.back().hessian.begin()->second += Expression(1);
  EXPECT_EQ(verdict(second), Verdict::refuted);
  Mechanics shifted = mechanics;
  shifted.kernels.back().slots.front().position.constant += 1;
  EXPECT_EQ(verdict(shifted), Verdict::refuted);
}

}  // namespace
}  // namespace hamgen
