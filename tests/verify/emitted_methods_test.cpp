// The proof that the emitted code is the mathematics, for what is not a single member of its own
// order: splittings, compositions, Runge-Kutta methods, and members with K in place of H.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "generator/equations/step_equations.hpp"
#include "generator/mechanics/modified_hamiltonian.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/verify/proof.hpp"
#include "tests/verify/evaluator.hpp"
#include "tests/verify/mutants.hpp"

namespace hamgen::verify_test {
namespace {

const std::string kPendulum =
    "coordinate q\nmomentum p\nparameter eps = 0.03\nH = p^2/2 - eps*cos(q)\n";
const std::string kHenonHeiles =
    "coordinate q1, q2\nmomentum p1, p2\n"
    "H = (p1^2 + p2^2)/2 + (q1^2 + q2^2)/2 + q1^2*q2 - q2^3/3\n";
const std::string kKepler =
    "coordinate x, y\nmomentum px, py\nparameter mu = 1\nH = (px^2 + py^2)/2 - mu/sqrt(x^2 + "
    "y^2)\n";
const std::string kMasses =
    "coordinate x, y\nmomentum px, py\nparameter m = 2\nH = px^2/(2*m) + py^2/2 + cos(x - y)\n";
const std::string kProduct = "coordinate q\nmomentum p\nH = (q^2 + 1)*(p^2 + 1)/2\n";

Finding prove(const Mechanics& mechanics, const Scheme& scheme, const LoweredStep& lowered,
              const Program& code) {
  return prove_emitted(mechanics, scheme, lowered.plan, code, mechanics.energy);
}
Finding prove(const Mechanics& mechanics, const Scheme& scheme, const LoweredStep& lowered) {
  return prove(mechanics, scheme, lowered, build_program(lowered));
}

Expression number(long over, long under) { return Expression(Rational(over, under)); }

Scheme member(int n, const Expression& alpha, const Expression& beta, const Expression& gamma) {
  return family_member(n, {{alpha}}, {{beta}}, {{gamma}});
}

Scheme named(const std::string& name, const Mechanics& mechanics) {
  const Scheme& scheme = *find_scheme(name);
  if (std::holds_alternative<Composition>(scheme.method)) {
    return compose(
        scheme, member(mechanics.degrees_of_freedom, number(1, 2), Expression(0), Expression(0)));
  }
  return for_system(scheme, mechanics);
}

struct Case {
  std::string name;
  std::string text;
  int order = 0;  // of K, with the gauge 3/10, 1/5, -1/10 if it is odd
  std::string solver = "";
  bool lanes = false;  // are stages computed together?
};

Scheme scheme_of(const Case& c, const Mechanics& mechanics) {
  if (c.order == 0) return named(c.name, mechanics);
  const bool midpoint = c.order % 2 == 0;
  return raise_order(
      midpoint ? member(mechanics.degrees_of_freedom, number(1, 2), Expression(0), Expression(0))
               : member(mechanics.degrees_of_freedom, number(3, 10), number(1, 5), number(-1, 10)),
      c.order);
}

std::vector<Case> cases() {
  return {
      {"stormer-verlet", kPendulum},
      {"ruth-3", kHenonHeiles},
      {"saba-2", kKepler},
      {"yoshida-4", kKepler},
      {"suzuki-4", kProduct},
      {"gauss-4", kHenonHeiles},
      {"gauss-6", kProduct, 0, "fixed-point"},
      {"gauss-6", kMasses, 0, "fixed-point", true},
      {"gauss-4", kMasses, 0, "", true},
      {"rk4", kKepler},
      {"order 4, midpoint", kPendulum, 4},
      {"order 6, midpoint", kKepler, 6},
      {"order 4, midpoint, nothing torn", kProduct, 4},
      {"order 3, general member", kHenonHeiles, 3},
  };
}

// Of a K nothing is more than tested: that it is the generating function of the flow is no
// polynomial identity.
Verdict expected_verdict(const Case& c) { return c.order == 0 ? Verdict::proved : Verdict::tested; }

TEST(EmittedMethods, AreTheMathematics) {
  for (const Case& c : cases()) {
    const Mechanics mechanics = mechanics_of(c.text);
    const Scheme scheme = scheme_of(c, mechanics);
    const LoweredStep lowered = lowered_of(mechanics, scheme, c.solver, c.lanes);
    const Finding finding = prove(mechanics, scheme, lowered);
    EXPECT_EQ(finding.verdict, expected_verdict(c)) << c.name << ": " << finding.detail;
    if (c.order > 0) {
      EXPECT_NE(finding.detail.find("at 200 points to 1e-30"), std::string::npos) << finding.detail;
    }
  }
}

// y has the slope of a K whose Hessian is not that of the Newton before it: it is to take the
// solution with the last increment.
TEST(EmittedMethods, WhatFollowsASimplifiedNewtonIsTheMathematics) {
  const Mechanics mechanics =
      mechanics_of("coordinate x, y\nmomentum px, py\nH = px^2/2 + x^3/3 + py*x\n");
  const auto of_order = [](int order) { return Case{.name = "", .text = "", .order = order}; };
  const Scheme scheme = scheme_of(of_order(6), mechanics);
  StepEquations equations = discretise(mechanics, scheme);
  const StepEquations shorter = discretise(mechanics, scheme_of(of_order(4), mechanics));
  equations.function->hessian = shorter.function->hessian;
  equations.function->hessian_order = 4;
  equations.mechanics.hessian = shorter.function->hessian;
  const SolvePlan plan = plan_solve(equations, "");
  ASSERT_NE(to_text(plan).find("simplified Newton of size 2 on x, px\n"), std::string::npos)
      << to_text(plan);
  const Finding finding = prove(mechanics, scheme, lower_step(plan));
  EXPECT_EQ(finding.verdict, Verdict::tested) << finding.detail;
}

TEST(EmittedMethods, EveryMutationIsRefuted) {
  int equivalent = 0;
  int total = 0;
  std::size_t first = 0;
  std::map<std::string, int> by_kind;
  for (const Case& c : cases()) {
    const Mechanics mechanics = mechanics_of(c.text);
    const Scheme scheme = scheme_of(c, mechanics);
    const LoweredStep original = lowered_of(mechanics, scheme, c.solver, c.lanes);
    const Program code = build_program(original);
    std::vector<Mutant> mutants = mutants_of(code, {5, first});
    for (Mutant& mutant : mutants_of_structure(code, {5, first++}))
      mutants.push_back(std::move(mutant));
    int of_case = 0;
    for (const Mutant& mutant : mutants) {
      if (computes_the_same(code, mutant.code)) {
        ++equivalent;
        continue;
      }
      const Finding finding = prove(mechanics, scheme, original, mutant.code);
      EXPECT_EQ(finding.verdict, Verdict::refuted)
          << c.name << ", " << mutant.kind << ": " << mutant.description << "\n"
          << finding.detail;
      ++of_case;
      ++by_kind[mutant.kind];
    }
    EXPECT_GE(of_case, 3) << c.name;
    total += of_case;
  }
  std::string counts;
  for (const auto& [name, count] : by_kind) counts += fmt::format(", {} {}", count, name);
  fmt::print("{} mutants{}; {} others compute the same\n", total, counts, equivalent);
  EXPECT_GE(total, 90);
  EXPECT_GE(by_kind.size(), 7U);
}

TEST(EmittedModifiedEnergies, AreTheSeriesAndEveryMutationIsRefuted) {
  int total = 0;
  for (const Case& c : {Case{"implicit-midpoint", kPendulum}, Case{"symplectic-euler-a", kPendulum},
                        Case{"implicit-midpoint", kHenonHeiles}}) {
    const Mechanics mechanics = mechanics_of(c.text);
    const Scheme scheme = scheme_of(c, mechanics);
    LoweredStep original = lowered_of(mechanics, scheme, c.solver, c.lanes);
    const std::vector<Expression> terms =
        modified_hamiltonian(mechanics, scheme.member().c, 0, scheme.symmetric ? 5 : 3);
    std::vector<Expression> sums;
    Expression sum;
    for (std::size_t j = 0; j < terms.size(); ++j) {
      sum += Expression::power(step_size(), Expression(static_cast<long>(j))) * terms[j];
      if (j == 0 || terms[j].is_zero()) continue;
      sums.push_back(sum);
      original.modified_powers.push_back(static_cast<int>(j));
    }
    EXPECT_EQ(sums.size(), 2U);
    original.modified_energies = evaluate_together(sums);
    EXPECT_EQ(prove(mechanics, scheme, original).verdict, Verdict::proved);
    // The step itself has its own test.
    const Program code = build_program(original);
    for (const Mutant& mutant : mutants_of(code, {2, 0}, {"modified_energies"})) {
      if (computes_the_same(code, mutant.code)) continue;
      EXPECT_EQ(prove(mechanics, scheme, original, mutant.code).verdict, Verdict::refuted)
          << c.name << ": " << mutant.description;
      ++total;
    }
  }
  EXPECT_GE(total, 20);
}

// The linearised step, from one without a solve to a matrix that is left to elimination.
std::vector<Case> tangent_cases() {
  const std::string ring =
      "size N = 5\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2 + (q[i+1] - q[i])^4/4 + q[i]^2/2)\n";
  // The index of the columns is no name of the model's.
  const std::string column =
      "coordinate q\nmomentum column\nH = column^2/2 + cos(q) + sin(q)*column/3\n";
  return {{"symplectic-euler-a", kPendulum}, {"implicit-midpoint", kPendulum},
          {"implicit-midpoint", kProduct},   {"implicit-midpoint", kKepler},
          {"implicit-midpoint", ring},       {"symplectic-euler-b", kProduct},
          {"yoshida-4", kHenonHeiles},       {"order 3, general member", kHenonHeiles, 3},
          {"implicit-midpoint", column}};
}

TEST(EmittedTangent, IsTheMathematicsAndEveryMutationIsRefuted) {
  int total = 0;
  std::size_t first = 0;
  for (const Case& c : tangent_cases()) {
    const Mechanics mechanics = mechanics_of(c.text);
    const Scheme scheme = scheme_of(c, mechanics);
    const LoweredStep without = lowered_of(mechanics, scheme, c.solver, c.lanes);
    if (!without.plan.equations.has_exact_hessian()) continue;
    const LoweredStep original = with_tangent(without);
    const Finding finding = prove(mechanics, scheme, original);
    EXPECT_LE(finding.verdict, Verdict::tested) << c.name << ": " << finding.detail;
    int of_case = 0;
    // The step itself has its own test.
    const Program code = build_program(original);
    for (const Mutant& mutant : mutants_of(code, {5, first++}, {"tangent", "substep_tangent"})) {
      if (computes_the_same(code, mutant.code)) continue;
      const Finding found = prove(mechanics, scheme, original, mutant.code);
      EXPECT_EQ(found.verdict, Verdict::refuted)
          << c.name << ", " << mutant.kind << ": " << mutant.description << "\n"
          << found.detail;
      ++of_case;
    }
    EXPECT_GE(of_case, 2) << c.name;
    total += of_case;
  }
  fmt::print("{} mutants of linearised steps\n", total);
  EXPECT_GE(total, 35);
}

// The lowered is built from the wrong K and agrees with it: only the flow can tell.
TEST(EmittedMethods, AWrongGeneratingFunctionIsRefuted) {
  const Expression h = Expression::symbol("h", kRankOfStep);
  for (const Case& c : cases()) {
    if (c.order == 0) continue;
    const Mechanics mechanics = mechanics_of(c.text);
    const Scheme scheme = scheme_of(c, mechanics);
    const StepEquations good = discretise(mechanics, scheme);
    auto refuted = [&](const std::string& what, auto alter) {
      StepEquations wrong = good;
      alter(*wrong.function);
      wrong.mechanics.gradient = wrong.function->gradient;
      wrong.mechanics.hessian = wrong.function->hessian;
      const LoweredStep lowered = lower_step(plan_solve(wrong, ""));
      const Finding finding = prove(mechanics, scheme, lowered);
      EXPECT_EQ(finding.verdict, Verdict::refuted) << c.name << ", " << what;
      return finding.detail;
    };
    // A term of the highest power of h, a part in 1e12 of the gradient.
    const Expression last = Expression::power(h, Expression(c.order - 1));
    EXPECT_NE(refuted("last power",
                      [&](GeneratingFunction& k) {
                        k.gradient[0] +=
                            Expression(Rational(1, 1000000000000)) * last * mechanics.variable(0);
                      })
                  .find(fmt::format("the term in h^{} of the step", c.order)),
              std::string::npos);
    // Beyond the order anything goes, but it must be a gradient.
    EXPECT_NE(refuted("not a gradient",
                      [&](GeneratingFunction& k) {
                        k.gradient[0] += last * h * mechanics.variable(0) *
                                         mechanics.variable(mechanics.degrees_of_freedom);
                      })
                  .find("symmetric"),
              std::string::npos);
    EXPECT_NE(refuted("Hessian",
                      [&](GeneratingFunction& k) {
                        k.hessian.begin()->second = k.hessian.begin()->second * number(1001, 1000);
                      })
                  .find("the Hessian of K"),
              std::string::npos);
  }
}

Finding swept(const std::string& text, int sweeps, const Expression& alpha) {
  const Mechanics mechanics = mechanics_of(text);
  return prove_swept(
             mechanics,
             member(mechanics.degrees_of_freedom, alpha, Expression(0), Expression(0)).member(),
             sweeps)
      .front();
}

// Of a substep of h/2 the term in h^3 is an eighth.
TEST(Sweeps, OfSubstepsHaveTheirLengths) {
  const Mechanics mechanics = mechanics_of(kPendulum);
  const Member midpoint = member(1, number(1, 2), Expression(0), Expression(0)).member();
  const auto first_term = [&](const Expression& part) {
    const std::string detail = prove_swept(mechanics, midpoint, 1, {}, {part}).front().plain();
    const std::string words = "begins with ";
    const std::size_t at = detail.find(words);
    EXPECT_NE(at, std::string::npos) << detail;
    EXPECT_NE(detail.find(" h^3 at", at), std::string::npos) << detail;
    return at == std::string::npos ? 0.0 : std::stod(detail.substr(at + words.size()));
  };
  const double whole = first_term(Expression(1));
  EXPECT_GT(std::abs(whole), 1e-6);
  EXPECT_NEAR(first_term(number(1, 2)), whole / 8, 1e-3 * std::abs(whole));
}

// Each sweep wins a power of h from h^2 of the predictor on: K + 2, unless it cancels.
TEST(Sweeps, AreRefutedWithTheOrderOfTheirDefect) {
  for (int sweeps = 1; sweeps <= 4; ++sweeps) {
    for (const std::string& text : {kPendulum, kKepler, kProduct}) {
      const Finding finding = swept(text, sweeps, number(1, 2));
      EXPECT_EQ(finding.verdict, Verdict::refuted);
      EXPECT_NE(finding.plain().find(fmt::format("is O(h^{}), by its power series", sweeps + 2)),
                std::string::npos)
          << finding.detail;
    }
  }
  // In a spring the error begins with a multiple of (J S)^(K + 2), which for odd K is itself
  // Hamiltonian and does no harm.
  const std::string spring = "coordinate q\nmomentum p\nH = p^2/2 + q^2\n";
  EXPECT_NE(swept(spring, 1, number(1, 2)).detail.find("O(h^4)"), std::string::npos);
  EXPECT_NE(swept(spring, 2, number(1, 2)).detail.find("O(h^4)"), std::string::npos);
}

TEST(Sweeps, ThatSolveTheEquationsAreNotRefuted) {
  // alpha = 0, separable: P depends on q alone, and one sweep has it.
  EXPECT_EQ(swept(kPendulum, 1, Expression(0)).verdict, Verdict::proved);
  EXPECT_EQ(swept(kProduct, 1, Expression(0)).verdict, Verdict::refuted);
}

}  // namespace
}  // namespace hamgen::verify_test
