#include "generator/mechanics/cancelling_forces.hpp"

#include <gtest/gtest.h>

#include <string>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"

namespace hamgen {
namespace {

std::map<int, CancellingForce> forces_of(const std::string& text) {
  return cancelling_forces(derive(read_model(make_source("m.ham", text))));
}
std::map<int, CancellingForce> forces_of_potential(const std::string& potential) {
  return forces_of("coordinate q\nmomentum p\nparameter k = 3\nH = p^2/2 + " + potential + "\n");
}

TEST(CancellingForces, AreThoseWhoseTermsDependOnTheStateAndVanishTogetherAtZero) {
  const auto of_exponential = forces_of_potential("exp(q) - q");
  ASSERT_TRUE(of_exponential.contains(0));
  EXPECT_EQ(to_text(of_exponential.at(0).terms), "2");  // 1 + 1
  EXPECT_EQ(to_text(of_exponential.at(0).slope), "1");
  // A product of sums, and numbers to the power of two above them: 4, 6.
  const auto of_product = forces_of_potential("3*(1 - exp(-q))^2/4");
  ASSERT_TRUE(of_product.contains(0));
  EXPECT_EQ(to_text(of_product.at(0).terms), "4");
  EXPECT_EQ(to_text(of_product.at(0).slope), "2");
  EXPECT_EQ(to_text(of_product.at(0).reach()), "1");
  const auto of_parameter = forces_of_potential("k*(exp(q) - q)");
  ASSERT_TRUE(of_parameter.contains(0));
  EXPECT_EQ(to_text(of_parameter.at(0).terms), "2*abs(k)");
  EXPECT_EQ(to_text(of_parameter.at(0).slope), "abs(k)");
  // They all vanish at zero, or do not together, or do not depend on the state, or have no value.
  // Nor do terms round near zero that are constant there.
  for (const char* potential : {"sin(q) - q", "k*(sin(q) - q) + q^2", "q^2/2 + q^4/4", "1 - cos(q)",
                                "exp(q)", "k*q", "1/q", "log(q)"})
    EXPECT_TRUE(forces_of_potential(potential).empty()) << potential;
}

TEST(CancellingForces, InLoopsAreThoseOfAnElementAmongOthers) {
  const auto in_loops = [](const std::string& sum) {
    return cancelling_force_in_loops(derive(
        read_model(make_source("m.ham",
                               "size N = 100\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
                               "H = sum(i = 1..N, p[i]^2/2 + " +
                                   sum + ")\n"))));
  };
  const auto ring = in_loops("exp(q[i] - q[i+1])");
  ASSERT_TRUE(ring);
  EXPECT_EQ(to_text(ring->terms), "2");
  EXPECT_EQ(to_text(ring->slope), "2");
  EXPECT_FALSE(in_loops("(q[i] - q[i+1])^2/2 + (q[i] - q[i+1])^4/4"));
  EXPECT_FALSE(in_loops("exp(q[i])"));
  // Nor where some have much larger terms than others, for all would be rounded with these.
  EXPECT_FALSE(in_loops("exp(q[i] - q[i+1])) + sum(i = 1..N-30, 10*(exp(q[i]) - q[i])"));
  EXPECT_TRUE(in_loops("exp(q[i] - q[i+1])) + sum(i = 1..N-30, q[i]^4"));
}

TEST(CancellingForces, HaveOneLengthForAllWhereThatIsAlike) {
  const Mechanics mechanics = derive(read_model(make_source(
      "m.ham", "coordinate q\nmomentum p\nparameter k = 3\nH = p^2/2 + k*(exp(q) - q)\n")));
  const Expression k = Expression::symbol("k");
  const Expression h = Expression::symbol("h");
  EXPECT_EQ(common_length(mechanics, {h * k, h * Expression(40)}), h * k);
  EXPECT_FALSE(common_length(mechanics, {h * k, h * Expression(50)}));
  EXPECT_FALSE(common_length(mechanics, {h * k, h * h * k}));
  EXPECT_FALSE(common_length(mechanics, {h * k, Expression(0)}));
  EXPECT_FALSE(common_length(mechanics, {}));
}

TEST(CancellingForces, RoundTheSolutionLessThanTheForceWhereThatIsStiff) {
  const CancellingForce force{Expression(2), Expression(1)};
  const Expression h = Expression::symbol("h");
  EXPECT_EQ(to_text(rounded_beside(force, h * h * Expression(Rational(1, 4)))),
            "h^2/2/(1 + h^2/4)");
}

TEST(CancellingForces, RoundCoordinatesByWayOfTheMomenta) {
  const Mechanics mechanics = derive(read_model(make_source(
      "m.ham", "coordinate x, y\nmomentum u, v\nH = u^2/2 + v^2/8 + y^2/2 + exp(x) - x\n")));
  const Expression h = Expression::symbol("h");
  const Expression half = h * Expression(Rational(1, 2));
  const std::vector<Expression> beside = rounded_beside(mechanics, [&](int i, int k) {
    if (i < 2) return k == i + 2 ? half : Expression(0);
    return k == i - 2 ? -half : Expression(0);
  });
  ASSERT_EQ(beside.size(), 4u);
  EXPECT_EQ(to_text(beside[0]), "h^2/2/(1 + (x^2 + y^2)^8)/(1 + h^2/4)");
  EXPECT_EQ(to_text(beside[2]), "abs(h)/(1 + (x^2 + y^2)^8)/(1 + h^2/4)");
  EXPECT_TRUE(beside[1].is_zero());
  EXPECT_TRUE(beside[3].is_zero());
}

}  // namespace
}  // namespace hamgen
