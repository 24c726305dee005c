// The proof that emitted code is the mathematics, where the sums of H are loops.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/pipeline.hpp"
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

// t in all summands.
const std::string kDriven =
    "size N = 24\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\ntime t\n"
    "parameter m[1..N] = 2\nH = sum(i = 1..N, p[i]^2/(2*m[i]) - cos(t)*q[i])"
    " + sum(i = 0..N, (1 + t)*(q[i+1] - q[i])^4/4)\n";

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
      {"Newton", "", uniform(n, Expression(Rational(1, 2)), zero, zero)},
      {"Newton, full gauge", "",
       uniform(n, Expression(Rational(1, 3)), Expression(Rational(1, 5)),
               Expression(Rational(1, 7)))},
      {"fixed point", "fixed-point", uniform(n, Expression(Rational(1, 2)), zero, zero)},
      {"sweeps", "sweeps:2",
       uniform(n, Expression(Rational(2, 5)), Expression(Rational(1, 9)), zero)},
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
      {"composition", "",
       compose(*find_scheme("yoshida-4"), uniform(n, Expression(Rational(1, 2)), zero, zero))});
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
  for (const std::string& text : {kChain, kCoupledRing, kRotators, kDriven}) {
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

// t is held, so that where it begins is where it ends: a prediction will not do.
TEST(EmittedLoops, TheTimeIsGivenWhereverAnIterationStarts) {
  const auto [mechanics, hamiltonian] = loops_of(kDriven);
  const Scheme scheme = uniform(mechanics.degrees_of_freedom, Expression(Rational(1, 2)),
                                Expression(0), Expression(0));
  for (const char* solver : {"", "newton", "fixed-point"}) {
    const LoweredStep lowered = lowered_of(mechanics, scheme, solver);
    Program code = build_program(lowered);
    Body& body = std::ranges::find(code.routines, "solve", &Routine::name)->body;
    const auto start = std::ranges::find_if(
        body, [](const Instruction& each) { return std::holds_alternative<If>(each.value); });
    ASSERT_NE(start, body.end());
    ASSERT_TRUE(std::holds_alternative<Assign>(std::next(start)->value));
    std::get<If>(start->value).then.push_back(std::move(*std::next(start)));
    body.erase(std::next(start));
    const Finding finding = prove_emitted(mechanics, scheme, lowered.plan, code, hamiltonian);
    EXPECT_EQ(finding.verdict, Verdict::refuted) << solver << finding.detail;
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
  EXPECT_GE(refuted_mutants({kDriven}), 8);
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

// Its products with H'' or V'': one of so many of their instructions left out, and then a term
// added that is free of the vector.
void expect_products_have_every_term_and_no_other(const std::string& text, const char* solver,
                                                  std::size_t every, bool tangent = false,
                                                  const Rational& alpha = Rational(1, 2)) {
  const auto [mechanics, hamiltonian] = loops_of(text);
  const Scheme scheme =
      uniform(mechanics.degrees_of_freedom, Expression(alpha), Expression(0), Expression(0));
  LoweredStep lowered = lowered_of(mechanics, scheme, solver);
  if (tangent) lowered = with_tangent(std::move(lowered));
  const Program code = build_program(lowered);
  const auto verdict = [&, &mechanics = mechanics, &hamiltonian = hamiltonian](const Program& c) {
    return prove_emitted(mechanics, scheme, lowered.plan, c, hamiltonian).verdict;
  };
  ASSERT_EQ(verdict(code), Verdict::proved);
  const std::set<std::string> products = {"curvature", "potential_curvature"};
  int mutants = 0;
  for (const verify_test::Mutant& mutant : mutants_of_structure(code, {every, 0}, products)) {
    if (computes_the_same(code, mutant.code)) continue;
    EXPECT_EQ(verdict(mutant.code), Verdict::refuted) << mutant.kind << ": " << mutant.description;
    ++mutants;
  }
  EXPECT_GE(mutants, 2);

  Program moved = code;
  const auto product = std::ranges::find_if(
      moved.routines, [&](const Routine& routine) { return products.contains(routine.name); });
  ASSERT_NE(product, moved.routines.end());
  Program alone = code;
  alone.routines = {*product};
  int terms = 0;
  verify_test::for_each_expression(alone, [&](Expression& e) {
    const bool has_vector = to_text(e).find("at u[") != std::string::npos;
    if (has_vector && terms++ == 0) e = e + Expression(1);
  });
  ASSERT_GT(terms, 0);
  *product = alone.routines[0];
  EXPECT_EQ(verdict(moved), Verdict::refuted);
}

TEST(EmittedLoops, ProductsWithTheHessianHaveEveryTermAndNoOther) {
  for (const std::string& text : {kSprings, kTurningSprings, kCoupledRing, kChain})
    expect_products_have_every_term_and_no_other(text, "newton", 8);
}

// The step has none of its own, or that of V''; the tangent map has that of H''.
TEST(EmittedLoops, ProductsOfTheTangentMapHaveEveryTermAndNoOther) {
  for (const char* solver : {"fixed-point", "newton"})
    expect_products_have_every_term_and_no_other(kChain, solver, 16, true);
  expect_products_have_every_term_and_no_other(kChain, "", 16, true, 0);  // explicit
}

// Of the K that stands in for H, too.
TEST(EmittedLoops, OfARaisedMemberAreTheMathematicsAndNoMutantIs) {
  const auto [mechanics, hamiltonian] = loops_of(
      "size N = 25\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^3/3)\n");
  const int n = mechanics.degrees_of_freedom;
  const Scheme scheme =
      raise_order(uniform(n, Expression(Rational(1, 2)), Expression(0), Expression(0)), 4);
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

// The neighbours of a ring meet where a loop of them ends: one instance in every part of a routine.
TEST(EmittedLoops, AFunctionOfASumOverARingIsProved) {
  const std::string ring =
      "size N = 12\ncoordinate x[1..N] periodic\nmomentum u[1..N]\n"
      "H = sum(i = 1..N, u[i]^2/2) + sum(i = 1..N, cos(x[i] - x[i+1]))^2\n";
  for (const char* scheme : {"", "stormer-verlet", "gauss-4"}) {
    const SourceText source = make_source("ring.ham", ring);
    const Request request{.scheme = scheme, .in_loops = true};
    const Proof proof = verify_step(source, request);
    const auto emitted = std::ranges::find(proof, kEmittedCode, &Finding::property);
    ASSERT_NE(emitted, proof.end());
    EXPECT_EQ(emitted->verdict, Verdict::proved) << scheme << emitted->detail;
  }
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
  const Scheme scheme = uniform(mechanics.degrees_of_freedom, Expression(Rational(1, 2)),
                                Expression(0), Expression(0));
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
