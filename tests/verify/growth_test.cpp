// What is proved of short chains holds for long ones that continue them, and for no others.
#include "generator/verify/growth.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "generator/verify/proof.hpp"
#include "tests/verify/evaluator.hpp"
#include "tests/verify/mutants.hpp"
#include "tests/verify/sized_system.hpp"

namespace hamgen {
namespace {

using verify_test::computes_the_same;
using verify_test::kernels;
using verify_test::lowered_of;
using verify_test::routines;
using verify_test::system_of;

// By its kernels or by its routines.
std::string why_not(const std::string& text, const std::string& solver = "fixed-point") {
  const SizedSystem a = system_of(text, 25, "implicit-midpoint", 2, solver);
  const SizedSystem b = system_of(text, 26, "implicit-midpoint", 2, solver);
  const SizedSystem c = system_of(text, 40, "implicit-midpoint", 2, solver);
  const auto of_kernels = why_not_longer({{kernels(a), kernels(b), kernels(c)}});
  return of_kernels ? *of_kernels
                    : why_not_longer({{routines(a), routines(b), routines(c)}}).value_or("");
}

const std::string kVariables = "coordinate q[1..N] periodic\nmomentum p[1..N]\n";
const std::string kKinetic = "H = sum(i = 1..N, p[i]^2/2) + ";
const std::string kGrowingChain =
    "coordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\nparameter m[1..N] = 2\n"
    "H = sum(i = 1..N, p[i]^2/(2*m[i])) + sum(i = 0..N, (q[i+1] - q[i])^4/4)\n";

const std::string kBodies =
    "coordinate x[1..N], y[1..N]\nmomentum px[1..N], py[1..N]\nparameter m[1..N] = 2\n"
    "H = (sum(i = 1..N, (px[i]^2 + py[i]^2)/(2*m[i]))"
    " - sum(i = 1..N, j = i+1..N, m[i]*m[j]/sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2)))\n";

TEST(Growth, ContinuesChainsAndRings) {
  EXPECT_EQ(why_not(kGrowingChain), "");
  EXPECT_EQ(why_not(kVariables + kKinetic + "sum(i = 1..N, (q[i+1] - q[i])^4/4)\n"), "");
  EXPECT_EQ(why_not(kVariables + kKinetic + "sum(i = 1..N, q[i]*q[i+2] + q[i]^4/4)\n"), "");
}

TEST(Growth, ContinuesSumsOverPairs) {
  for (const char* range : {"j = 1..i - 1", "j = i+1..N", "j = 1..N"}) {
    EXPECT_EQ(why_not(kVariables + kKinetic +
                      fmt::format("sum(i = 1..N, sum({}, (q[i] - q[j])^4))\n", range)),
              "")
        << range;
  }
  EXPECT_EQ(why_not(kBodies), "");
}

TEST(Growth, DoesNotReachBeyondNeighbours) {
  EXPECT_EQ(why_not(kVariables + kKinetic + "sum(i = 1..N, i*q[i]^2)\n"),
            "its instances depend on their index");
  EXPECT_EQ(why_not(kVariables + kKinetic + "sum(i = 1..N, q[i]^2/N)\n"),
            "its routines have other instructions");
  // The slope of the one that all meet is a sum, which is read when it is whole.
  EXPECT_EQ(why_not(kVariables + kKinetic + "sum(i = 2..N, (q[i] - q[1])^2)\n"), "");
  EXPECT_EQ(why_not(kVariables + kKinetic + "sum(i = 2..N, (q[i] - q[1])^4)\n", "newton"),
            "all elements meet in one");
  EXPECT_EQ(why_not(kVariables + kKinetic +
                    "sum(i = 1..N, sum(j = i+1..N, (q[i] - q[j])^4*(q[1] - q[j])^2))\n"),
            "all elements meet in one");
  EXPECT_EQ(why_not(kVariables + kKinetic + "sum(i = 1..N, sum(j = i+1..N, (j - i)*q[i]*q[j]))\n"),
            "its instances depend on their index");
  EXPECT_EQ(why_not(kVariables + kKinetic +
                    "sum(i = 1..N, sum(j = i+1..N, sum(k = j+1..N, q[i]*q[j]*q[k])))\n"),
            "the ends of a loop move with another one's index");
  EXPECT_EQ(why_not(kVariables + kKinetic +
                    "sum(i = 1..N, sum(j = 1..N, sum(k = 1..N, "
                    "q[i]*q[j]*q[k])))\n"),
            "a sum runs over more than pairs");
  EXPECT_EQ(why_not(kVariables + kKinetic + "sum(i = 1..12, q[2*i]^4) + sum(i = 1..N, q[i]^2)\n"),
            "its loops reach 23 elements far");
}

// The large system has the claims of the small ones; a mutant of it is not what they continue.
TEST(Growth, ProvesTheLongChainAndNoMutantOfIt) {
  for (const std::string scheme : {"implicit-midpoint", "stormer-verlet", "gauss-4", "rk4"}) {
    const SizedSystem a = system_of(kGrowingChain, 9, scheme);
    const SizedSystem b = system_of(kGrowingChain, 10, scheme);
    const SizedSystem c = system_of(kGrowingChain, 60, scheme);
    const Finding finding = prove_emitted(c.mechanics, c.scheme, c.plan, c.program, c.hamiltonian,
                                          {}, {}, SmallerSystems{"N", 60, a, b});
    EXPECT_EQ(finding.verdict, Verdict::proved) << scheme << ": " << finding.detail;
    const SizedOutline first = routines(a);
    const SizedOutline second = routines(b);
    int mutants = 0;
    const auto refuse = [&](const std::vector<verify_test::Mutant>& list) {
      for (const verify_test::Mutant& mutant : list) {
        const auto why =
            why_not_longer({{first, second, {60, outline(mutant.code, {"invariants"})}}});
        EXPECT_TRUE(why || computes_the_same(c.program, mutant.code))
            << scheme << ", " << mutant.kind << ": " << mutant.description;
        ++mutants;
      }
    };
    refuse(verify_test::mutants_of(c.program));
    refuse(verify_test::mutants_of_structure(c.program));
    EXPECT_GE(mutants, 20) << scheme;
  }
}

// sin(x - y) and sin(y - x) are one function, whichever comes first.
TEST(Growth, ProvesARingOfAnglesByAlgebra) {
  const std::string ring =
      kVariables + kKinetic + "sum(i = 1..N, cos(q[i+1] - q[i]) + cos(q[i+2] - q[i])/4)\n";
  const SizedSystem a = system_of(ring, 25, "implicit-midpoint");
  const SizedSystem b = system_of(ring, 26, "implicit-midpoint");
  const SizedSystem c = system_of(ring, 60, "implicit-midpoint");
  const Finding finding = prove_emitted(c.mechanics, c.scheme, c.plan, c.program, c.hamiltonian, {},
                                        {}, SmallerSystems{"N", 60, a, b});
  EXPECT_EQ(finding.verdict, Verdict::proved) << finding.detail;
}

// So have bodies that all know each other: three sizes, as constants may grow with their pairs.
TEST(Growth, ProvesManyBodiesAndNoMutantOfThem) {
  for (const std::string scheme : {"implicit-midpoint", "stormer-verlet", "gauss-2"}) {
    const SizedSystem a = system_of(kBodies, 8, scheme);
    const SizedSystem b = system_of(kBodies, 9, scheme);
    const SizedSystem c = system_of(kBodies, 10, scheme);
    const SizedSystem large = system_of(kBodies, 40, scheme);
    const auto proved_by = [&](const SmallerSystems& smaller) {
      return prove_emitted(large.mechanics, large.scheme, large.plan, large.program, {}, {}, {},
                           smaller);
    };
    EXPECT_EQ(proved_by({"N", 40, a, b, c}).verdict, Verdict::proved) << scheme;
    EXPECT_EQ(proved_by({"N", 40, a, b}).verdict, Verdict::tested) << scheme;
    if (scheme != "stormer-verlet") continue;
    const SizedOutline first = routines(a);
    const SizedOutline second = routines(b);
    int mutants = 0;
    const auto refuse = [&](const std::vector<verify_test::Mutant>& list) {
      for (const verify_test::Mutant& mutant : list) {
        const auto why =
            why_not_longer({{first, second, {40, outline(mutant.code, {"invariants"})}}});
        EXPECT_TRUE(why || computes_the_same(large.program, mutant.code))
            << scheme << ", " << mutant.kind << ": " << mutant.description;
        ++mutants;
      }
    };
    refuse(verify_test::mutants_of(large.program));
    refuse(verify_test::mutants_of_structure(large.program));
    EXPECT_GE(mutants, 20) << scheme;
  }
}

// H'' times a vector is a sum over pairs, of which the step knows nothing, as of the gradient.
// Where H is quadratic the step looks into it.
TEST(Growth, ProvesNewtonOfManyBodies) {
  const std::string linear =
      kVariables + kKinetic + "sum(i = 1..N, j = i+1..N, (q[i] - q[j])^2)/2\n";
  for (const auto& [text, verdict] :
       {std::pair(kBodies, Verdict::proved), std::pair(linear, Verdict::tested)}) {
    const long size = verdict == Verdict::proved ? 8 : 25;
    const auto sized = [&](long elements) {
      return system_of(text, elements, "implicit-midpoint", 2, "newton");
    };
    const SizedSystem large = sized(40);
    const Finding finding =
        prove_emitted(large.mechanics, large.scheme, large.plan, large.program, {}, {}, {},
                      SmallerSystems{"N", 40, sized(size), sized(size + 1), sized(size + 2)});
    EXPECT_EQ(finding.verdict, verdict) << finding.detail;
    if (verdict == Verdict::tested) {
      EXPECT_TRUE(finding.detail.ends_with("a sum over pairs is looked into")) << finding.detail;
    }
  }
}

// A sum over the others may be added up; what is made of it is no sum over pairs.
TEST(Growth, AFunctionOfASumOverPairsIsNoSumOverPairs) {
  const auto squared = [](SizedSystem system) {
    for (Routine& routine : system.program.routines) {
      if (routine.name != "potential_gradient") continue;
      for (Instruction& outer : routine.body) {
        auto* loop = std::get_if<For>(&outer.value);
        if (loop == nullptr) continue;
        for (Instruction& inner : loop->body) {
          auto* sum = std::get_if<Accumulate>(&inner.value);
          if (sum != nullptr) sum->value = sum->value * sum->value;
        }
      }
    }
    return system;
  };
  const SizedSystem a = squared(system_of(kBodies, 13, "stormer-verlet"));
  const SizedSystem b = squared(system_of(kBodies, 14, "stormer-verlet"));
  const SizedSystem c = squared(system_of(kBodies, 40, "stormer-verlet"));
  EXPECT_EQ(why_not_longer({{routines(a), routines(b), routines(c)}}),
            "a sum over pairs is looked into");
}

// A mistake that all sizes share is found at the small ones.
TEST(Growth, AMistakeOfAllSizesIsRefuted) {
  const auto wrong = [](SizedSystem system) {
    for (Kernel& kernel : system.mechanics.kernels) {
      kernel.gradient.front() = kernel.gradient.front() * Expression(2);
    }
    const LoweredStep lowered = lowered_of(system.mechanics, system.scheme, "fixed-point");
    system.plan = lowered.plan;
    system.program = build_program(lowered);
    return system;
  };
  const SizedSystem large = system_of(kGrowingChain, 60, "implicit-midpoint");
  const SmallerSystems smaller{"N", 60, wrong(system_of(kGrowingChain, 9, "implicit-midpoint")),
                               wrong(system_of(kGrowingChain, 10, "implicit-midpoint"))};
  const Finding finding = prove_emitted(large.mechanics, large.scheme, large.plan, large.program,
                                        large.hamiltonian, {}, {}, smaller);
  EXPECT_EQ(finding.verdict, Verdict::refuted);
  EXPECT_NE(finding.detail.find("at N = 9: "), std::string::npos) << finding.detail;
}

// K at 2 h is a function whose step is symplectic too, and of no order but that of H.
SizedSystem with_other_function(SizedSystem system) {
  const Substitution twice = {{"h", Expression(2) * step_size()}};
  StepEquations& equations = system.plan.equations;
  for (Kernel& kernel : equations.function->kernels) {
    kernel.value = substitute(kernel.value, twice);
    for (Expression& slope : kernel.gradient) slope = substitute(slope, twice);
    for (auto& [slots, second] : kernel.hessian) second = substitute(second, twice);
  }
  equations.mechanics.kernels = equations.function->kernels;
  system.program = build_program(system.plan);
  return system;
}

// The order of a K in loops is that of shorter ones; where these are none, it is looked at itself.
TEST(Growth, TheOrderOfALongChainIsThatOfShortOnes) {
  const SizedSystem a = system_of(kGrowingChain, 25, "implicit-midpoint", 4);
  const SizedSystem b = system_of(kGrowingChain, 26, "implicit-midpoint", 4);
  const SizedSystem c = system_of(kGrowingChain, 60, "implicit-midpoint", 4);
  const auto order = [](const SizedSystem& of, const std::optional<Expression>& hamiltonian,
                        const std::optional<SmallerSystems>& smaller) {
    const Proof proof =
        verify(of.mechanics, of.scheme, of.plan, of.program, hamiltonian, {}, smaller);
    const auto is_order = [](const Finding& each) { return each.property.starts_with("order"); };
    const auto found = std::ranges::find_if(proof, is_order);
    EXPECT_EQ(proof.back().verdict, found->verdict) << proof.back().detail;
    return found->verdict;
  };
  const SmallerSystems smaller{"N", 60, a, b};
  EXPECT_EQ(order(c, {}, smaller), Verdict::tested);
  EXPECT_EQ(order(c, {}, {}), Verdict::not_decided);
  EXPECT_EQ(order(c, c.hamiltonian, {}), Verdict::tested);
  // One that is wrong at all sizes, and one that is wrong at the large one.
  const SizedSystem wrong = with_other_function(c);
  EXPECT_EQ(
      order(wrong, {}, SmallerSystems{"N", 60, with_other_function(a), with_other_function(b)}),
      Verdict::refuted);
  EXPECT_EQ(order(wrong, {}, smaller), Verdict::not_decided);
  EXPECT_EQ(order(wrong, wrong.hamiltonian, smaller), Verdict::refuted);
  // The flow of a higher order comes from farther away.
  EXPECT_LE(least_size_of_order(c.plan.equations), 25);
  const auto of_order_six = [](long size) {
    return system_of(kGrowingChain, size, "implicit-midpoint", 6);
  };
  const SizedSystem six = of_order_six(60);
  EXPECT_GT(least_size_of_order(six.plan.equations), 25);
  EXPECT_EQ(why_not_inherited(six.mechanics, six.plan, six.program,
                              {"N", 60, of_order_six(25), of_order_six(26)}),
            "the flow reaches farther than the smaller ones are long");
}

// Without smaller ones it is no proof.
TEST(Growth, ALargeSystemAloneIsTested) {
  const SizedSystem large = system_of(kGrowingChain, 60, "implicit-midpoint");
  const Finding finding =
      prove_emitted(large.mechanics, large.scheme, large.plan, large.program, large.hamiltonian);
  EXPECT_EQ(finding.verdict, Verdict::tested) << finding.detail;
  EXPECT_NE(finding.detail.find("the routines are not looked at"), std::string::npos)
      << finding.detail;
}

}  // namespace
}  // namespace hamgen
