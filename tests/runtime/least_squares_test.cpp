#include "runtime/least_squares.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace hamgen::runtime {
namespace {

using Samples = std::vector<double>;

template <class Function>
Samples sampled(const Function& f) {
  Samples samples;
  for (int i = 0; i < 200; ++i) samples.push_back(f(0.05 * i));
  return samples;
}

TEST(Flatten, FindsTheCombinationThatIsConstant) {
  const Samples sine = sampled([](double t) { return std::sin(t); });
  const Samples square = sampled([](double t) { return 4 + t * t; });
  const Samples target = sampled([](double t) { return 7 + 3 * std::sin(t) - t * t / 8; });
  const Flattening flat = flatten(target, {sine, square});
  // Samples are rounded to 2^-53 of at most 104; the columns are far from parallel.
  EXPECT_NEAR(flat.coefficients[0], -3, 1e-13);
  EXPECT_NEAR(flat.coefficients[1], 0.125, 1e-14);
  EXPECT_EQ(flat.rank, 2U);
  EXPECT_LT(flat.spread_after, 1e-13);
  EXPECT_GT(flat.spread_before, 10);
}

TEST(Flatten, LeavesWhatNoCombinationRemoves) {
  // Over whole periods sin is orthogonal to cos: it removes nothing.
  Samples sine, cosine;
  for (int i = 0; i < 64; ++i) {
    sine.push_back(std::sin(2 * M_PI * i / 64));
    cosine.push_back(std::cos(2 * M_PI * i / 64));
  }
  const Flattening flat = flatten(cosine, {sine});
  EXPECT_NEAR(flat.coefficients[0], 0, 1e-15);
  EXPECT_NEAR(flat.spread_after, 2, 1e-14);
  EXPECT_NEAR(flat.deviation_after, std::sqrt(0.5), 1e-14);
  EXPECT_EQ(flat.deviation_after, flat.deviation_before);
}

TEST(Flatten, LeavesOutFunctionsThatAreConstantOrDependent) {
  const Samples line = sampled([](double t) { return t; });
  const Samples twice = sampled([](double t) { return 2 * t + 5; });
  const Samples constant = sampled([](double) { return 0.3; });
  const Flattening flat = flatten(line, {constant, twice, line, Samples(200, 0.0)});
  EXPECT_EQ(flat.rank, 1U);
  EXPECT_EQ(flat.coefficients[0], 0);
  EXPECT_EQ(flat.coefficients[3], 0);
  // One of the two parallel ones does it all.
  EXPECT_NEAR(2 * flat.coefficients[1] + flat.coefficients[2], -1, 1e-14);
  EXPECT_LT(flat.spread_after, 1e-13);
}

TEST(Flatten, LeavesATargetThatIsFlatAlone) {
  const Samples line = sampled([](double t) { return t; });
  Samples target(200, 0.1);
  target[7] = std::nextafter(0.1, 1.0);
  const Flattening flat = flatten(target, {line});
  EXPECT_EQ(flat.coefficients[0], 0);
  EXPECT_EQ(flat.rank, 0U);
}

TEST(Flatten, RefusesSamplesThatDoNotFit) {
  EXPECT_THROW((void)flatten({}, {}), std::invalid_argument);
  EXPECT_THROW((void)flatten({1, 2}, {{1, 2, 3}}), std::invalid_argument);
  EXPECT_EQ(flatten({1, 2}, {}).spread_after, 1);
}

}  // namespace
}  // namespace hamgen::runtime
