// Functions of sums stay functions of sums.
#include "generator/mechanics/collective_sums.hpp"

#include <gtest/gtest.h>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {
namespace {

Mechanics of(const std::string& text) {
  return derive(read_model(make_source(
      "sums.ham", "system sums\nsize N = 30\ncoordinate q[1..N]\nmomentum p[1..N]\n" + text)));
}

TEST(CollectiveSums, AreKeptWithTheSlopesOfTheirFunction) {
  const Mechanics mechanics =
      of("parameter K = 1\nlet C = sum(i = 1..N, cos(q[i]))\n"
         "H = sum(i = 1..N, p[i]^2/2) - K*(C^2 + sum(i = 1..N, sin(q[i]))^2)/(2*N) + C\n");
  ASSERT_EQ(mechanics.sums.size(), 2u);
  EXPECT_EQ(mechanics.sums[0].name, "C");
  EXPECT_EQ(to_text(mechanics.sums[0].slope_value), "-K*C/30");
  EXPECT_EQ(to_text(mechanics.sums[1].slope_value), "-K*sum(2)/30");
  // The energy of motion, C by itself, and what the two sums are made of.
  EXPECT_EQ(mechanics.kernels.size(), 4u);
  EXPECT_TRUE(mechanics.is_separable());
}

TEST(CollectiveSums, OfCoordinatesAndMomentaOrOfElementsBesideAreWrittenOut) {
  const std::string kinetic = "H = sum(i = 1..N, p[i]^2/2) + ";
  for (const char* other :
       {"sum(i = 1..N, q[i])*sum(i = 1..N, p[i])", "(q[1] + sum(i = 1..N, q[i]))^2",
        "sum(i = 1..N, sum(j = 1..N, q[j])^2*q[i])"}) {
    EXPECT_FALSE(of(kinetic + other + "\n").keeps_sums()) << other;
  }
  EXPECT_TRUE(of(kinetic + "1/sum(i = 1..N, q[i]^2)\n").keeps_sums());
}

}  // namespace
}  // namespace hamgen
