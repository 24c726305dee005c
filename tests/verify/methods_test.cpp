// What algebra says of splittings, compositions and tableaus, on plain coefficients.
#include <gtest/gtest.h>

#include "generator/schemes/all_schemes.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {
namespace {

Expression q(long over, long under) { return Expression(Rational(over, under)); }

const Finding& find(const Proof& proof, std::string_view property) {
  for (const Finding& finding : proof) {
    if (finding.property.starts_with(property)) return finding;
  }
  ADD_FAILURE() << "no finding " << property;
  return proof.front();
}

TEST(Tableau, ExplicitEulerIsRefutedWithItsWitness) {
  const Proof proof = prove_tableau({{{Expression(0)}}, {Expression(1)}, {Expression(0)}}, 1);
  EXPECT_EQ(find(proof, "symplectic").verdict, Verdict::refuted);
  EXPECT_EQ(find(proof, "symplectic").plain(),
            "b_i a_ij + b_j a_ji - b_i b_j is -1 for i = 1, j = 1");
  EXPECT_EQ(find(proof, "symmetric").verdict, Verdict::refuted);
  EXPECT_EQ(find(proof, "order").property, "order 1");
}

RungeKutta rk4() {
  const Expression o(0);
  return {{{o, o, o, o}, {q(1, 2), o, o, o}, {o, q(1, 2), o, o}, {o, o, Expression(1), o}},
          {q(1, 6), q(1, 3), q(1, 3), q(1, 6)},
          {o, q(1, 2), q(1, 2), Expression(1)}};
}

TEST(Tableau, TheClassicalMethodIsRefutedAndHasOrderFour) {
  const Proof proof = prove_tableau(rk4(), 4);
  EXPECT_EQ(find(proof, "symplectic").verdict, Verdict::refuted);
  EXPECT_EQ(find(proof, "symplectic").plain(),
            "b_i a_ij + b_j a_ji - b_i b_j is -0.0277778 for i = 1, j = 1");
  EXPECT_EQ(find(proof, "order").property, "order 4");
  EXPECT_EQ(find(proof, "order").verdict, Verdict::proved);
}

TEST(Tableau, GaussWithTwoStagesIsSymplecticSymmetricAndOfOrderFour) {
  const Expression r = square_root(Expression(3)) / Expression(6);
  const RungeKutta gauss{{{q(1, 4), q(1, 4) - r}, {q(1, 4) + r, q(1, 4)}},
                         {q(1, 2), q(1, 2)},
                         {q(1, 2) - r, q(1, 2) + r}};
  const Proof proof = prove_tableau(gauss, 4);
  EXPECT_EQ(find(proof, "symplectic").verdict, Verdict::proved);
  EXPECT_EQ(find(proof, "symmetric").verdict, Verdict::proved);
  EXPECT_EQ(find(proof, "order").property, "order 4");
  RungeKutta wrong = gauss;
  wrong.a[0][1] += q(1, 1000000);
  EXPECT_EQ(find(prove_tableau(wrong, 4), "symplectic").verdict, Verdict::refuted);
  EXPECT_EQ(find(prove_tableau(wrong, 4), "order").property, "order 1");
}

TEST(Splitting, StormerVerletIsOfOrderTwoAndSymplecticFactorByFactor) {
  const Splitting verlet{true, {q(1, 2), q(1, 2)}, {Expression(1)}};
  const Proof proof = prove_splitting(verlet, 2, false);
  EXPECT_EQ(find(proof, "symplectic").verdict, Verdict::proved);
  EXPECT_EQ(find(proof, "symmetric").verdict, Verdict::proved);
  EXPECT_EQ(find(proof, "order").property, "order 2");
  EXPECT_EQ(find(proof, "order").verdict, Verdict::proved);
  // exp(B/2) exp(A) exp(B/2): log = A + B + [A,[A,B]]/12 - [B,[B,A]]/24 + ... (HLW III.5.3 with A
  // and B exchanged); AAB and ABB have the coefficient 1 in these brackets.
  EXPECT_NE(find(proof, "order").detail.find("0.08333 AAB, -0.04167 ABB"), std::string::npos)
      << find(proof, "order").detail;
}

TEST(Splitting, UnequalEndsAreNotSymmetricAndRuthsMethodHasOrderThree) {
  const Splitting ruth{true, {q(7, 24), q(3, 4), q(-1, 24)}, {q(2, 3), q(-2, 3), Expression(1)}};
  const Proof proof = prove_splitting(ruth, 3, false);
  EXPECT_EQ(find(proof, "symmetric").verdict, Verdict::refuted);
  EXPECT_EQ(find(proof, "order").property, "order 3");
  const Splitting wrong{true, {q(7, 24), q(3, 4), q(-1, 24)}, {q(2, 3), q(-2, 3), q(11, 10)}};
  EXPECT_EQ(find(prove_splitting(wrong, 3, false), "order").property, "order 0");
}

TEST(Composition, TheTripleJumpHasOrderFourAndItsLeadingError) {
  const Expression c = Expression(1) / (Expression(2) - Expression::power(Expression(2), q(1, 3)));
  const Scheme midpoint = family_member(1, {{q(1, 2)}}, {{Expression(0)}}, {{Expression(0)}});
  const Composition jump{midpoint.member(), {c, Expression(1) - Expression(2) * c, c}};
  const Proof proof = prove_composition(jump, 1, 4);
  EXPECT_EQ(find(proof, "symplectic").verdict, Verdict::proved);
  EXPECT_EQ(find(proof, "symmetric").verdict, Verdict::proved);
  EXPECT_EQ(find(proof, "order").property, "order 4");
  // The coefficient of Y5 is the sum of the fifth powers: 2 c^5 + (1 - 2c)^5 = -5.292.
  EXPECT_NE(find(proof, "order").detail.find("-5.29"), std::string::npos)
      << find(proof, "order").detail;
  const Composition wrong{midpoint.member(), {q(1, 3), q(1, 3), q(1, 3)}};
  EXPECT_EQ(find(prove_composition(wrong, 1, 4), "order").property, "order 2");
}

// To 34 digits of the coefficients; order and symmetry are found from them alone.
TEST(TheList, OfSplittingsAndCompositionsClaimsWhatIsProved) {
  const Scheme midpoint = family_member(1, {{q(1, 2)}}, {{Expression(0)}}, {{Expression(0)}});
  const auto expect_claims = [](const Scheme& scheme, const Proof& proof) {
    EXPECT_EQ(find(proof, "order").property, "order " + std::to_string(scheme.order))
        << scheme.name << ": " << find(proof, "order").detail;
    EXPECT_EQ(find(proof, "symmetric").verdict,
              scheme.symmetric ? Verdict::proved : Verdict::refuted)
        << scheme.name;
  };
  for (const Scheme& scheme : compositions()) {
    auto composition = std::get<Composition>(scheme.method);
    composition.base = midpoint.member();
    expect_claims(scheme, prove_composition(composition, 1, scheme.order));
  }
  for (const Scheme& scheme : splittings()) {
    const bool nystrom = scheme.needs.find("quadratic") != std::string::npos;
    expect_claims(scheme,
                  prove_splitting(std::get<Splitting>(scheme.method), scheme.order, nystrom));
  }
}

TEST(Member, AMatrixOutsideTheAlgebraIsRefutedWithTheEntry) {
  Scheme scheme = family_member(2, {{q(1, 2)}}, {{Expression(0)}}, {{Expression(0)}});
  Member member = scheme.member();
  // A random matrix is not in sp(4): it has 10 conditions to satisfy.
  long seed = 7;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      seed = (seed * 1103515245 + 12345) % 2147483648;
      member.c[{i, j}] = q(seed % 19 - 9, 10);
    }
  }
  const Finding gauge = prove_gauge(member);
  const Finding step = prove_step_symplectic(member, 2);
  EXPECT_EQ(gauge.verdict, Verdict::refuted);
  EXPECT_EQ(step.verdict, Verdict::refuted);
  EXPECT_TRUE(gauge.detail.starts_with("entry (")) << gauge.detail;
  EXPECT_NE(step.plain().find("of A+ J A+^T - A- J A-^T is "), std::string::npos) << step.detail;
}

}  // namespace
}  // namespace hamgen
