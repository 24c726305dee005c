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
        // rounding is not.  An affine block is corrected from where it is solved already, and
        // proved from anywhere.
        const bool is_affine = std::ranges::all_of(original.plan.blocks, [](const Block& block) {
          return block.kind == BlockKind::linear;
        });
        const bool is_made_up_for = finding.detail.starts_with("the stage value of ") ||
                                    (is_affine && finding.detail.starts_with("the increment of "));
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

}  // namespace
}  // namespace hamgen
