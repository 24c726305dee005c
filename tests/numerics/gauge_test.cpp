// Members with a full matrix C against the same step by hand: no generator, no blocks, no tearing.
#include <gtest/gtest.h>

#include <array>

#include "tests/numerics/dense_step.hpp"
#include "tests/numerics/emitted_run.hpp"

namespace hamgen::numerics_test {
namespace {

using Matrix = std::vector<Vector>;

// Z by fixed-point iteration on Z = z + h J grad H(zbar), zbar = (z + Z)/2 + C (Z - z).
template <class Hamiltonian>
Vector iterated_step(const Hamiltonian& hamiltonian, const Matrix& c, long double h,
                     const Vector& z) {
  Vector next = z;
  for (int iteration = 0; iteration < 200; ++iteration) {
    Vector bar(z.size());
    for (std::size_t i = 0; i < z.size(); ++i) {
      bar[i] = (z[i] + next[i]) / 2;
      for (std::size_t j = 0; j < z.size(); ++j) bar[i] += c[i][j] * (next[j] - z[j]);
    }
    next = advanced(hamiltonian, h, z, bar);
  }
  return next;
}

const auto kCoupled = [](const std::vector<Jet<long double>>& z) {
  return 0.5L * (z[2] * z[2] + z[3] * z[3]) + z[0] * z[1] * z[1] + z[1] * z[2] +
         0.25L * (z[0] * z[0] * z[0] * z[0]) + 0.5L * (z[1] * z[1]);
};
const char* const kCoupledText =
    "coordinate x, y\nmomentum px, py\n"
    "H = (px^2 + py^2)/2 + x*y^2 + y*px + x^4/4 + y^2/2\n";

TEST(Gauge, StepsWithFullMatricesAreTheStepsByHand) {
  const Request request{.alpha = "[[1/2 + 1/8, h/4], [-1/4, 1/2]]",
                        .beta = "[[1/4, h/2], [h/2, -1/8]]",
                        .gamma = "[[1/16, -1/4], [-1/4, h]]",
                        .scalar = "long-double"};
  const long double h = 0.0625L;
  // C = [[alpha - 1/2, -gamma], [-beta, 1/2 - alpha^T]].
  const Matrix c = {{0.125L, h / 4, -0.0625L, 0.25L},
                    {-0.25L, 0, 0.25L, -h},
                    {-0.25L, -h / 2, -0.125L, 0.25L},
                    {-h / 2, 0.125L, -h / 4, 0}};
  const Vector start = {0.5L, 0.25L, -0.125L, 0.375L};
  Vector by_hand = start;
  constexpr int steps = 32;
  for (int i = 0; i < steps; ++i) by_hand = iterated_step(kCoupled, c, h, by_hand);
  const Vector emitted = Emitted(kCoupledText, request).after(steps, start, h);
  // Both solve the step to a few units of 2^-64 of values below 1; the flow over t = 2 multiplies an
  // error by exp(2 |J H''|), below 100: 32 steps * 4 units * 100 = 12800 units.
  EXPECT_LT(distance(emitted, by_hand), 12800 * 0x1p-64L);
  // The matrix matters: without its entries off the diagonals the result is another one.
  const Request diagonal{.alpha = "1/2 + 1/8, 1/2",
                         .beta = "1/4, -1/8",
                         .gamma = "1/16, h",
                         .scalar = "long-double"};
  EXPECT_GT(distance(Emitted(kCoupledText, diagonal).after(steps, start, h), by_hand), 1e-4L);
}

TEST(Gauge, FullMatricesThatAreOddInHHaveOrderTwoAndOthersOrderOne) {
  const Vector start = {0.5L, 0.25L, -0.125L, 0.375L};
  const Vector exact =
      Emitted(kCoupledText, {.scalar = "long-double"}).after(1 << 14, start, 0x1p-13L);
  for (const auto& [beta, order] : {std::pair{"[[h, 2*h], [2*h, -h]]", 2.0},
                                    std::pair{"[[0, 1/4], [1/4, 0]]", 1.0}}) {
    const Emitted member(kCoupledText, {.beta = beta, .scalar = "long-double"});
    std::vector<long double> errors;
    for (int k = 5; k <= 8; ++k) {
      errors.push_back(distance(member.after(2 << k, start, std::ldexp(1.0L, -k)), exact));
    }
    EXPECT_NEAR(observed_orders(errors).back(), order, 0.1) << beta;
  }
}

}  // namespace
}  // namespace hamgen::numerics_test
