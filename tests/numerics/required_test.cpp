// The figures the method is known to reach.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/numerics/dense_step.hpp"
#include "tests/numerics/emitted_run.hpp"

namespace hamgen::numerics_test {
namespace {

struct Reference {
  std::string model;
  Vector start;
  long double t;
  Vector end;     // 18 digits, 113-bit arithmetic, an extrapolation integrator
  long double h;  // of the midpoint rule; the member of order 1 takes a tenth of it
};

const long double half_pi = std::numbers::pi_v<long double> / 2;

// Sources: A2, Jimenez-Perez and others 2015; A8, Tao, PRE 94 (2016) 043303; B1, Henon and Heiles,
// AJ 69 (1964) 73; B6, the double pendulum with unit masses and lengths.
std::vector<Reference> references() {
  return {
      {"pendulum", {0.8L, 0}, 100, {-0.487705690688532389L, 0.105840517980004865L}, 0.25L},
      {"pendulum", {2.5L, 0}, 100, {-1.29772507248023753L, 0.253475889400307744L}, 0.25L},
      {"pendulum", {3.1L, 0}, 100, {2.29712982881406863L, 0.141774928393845888L}, 0.1L},
      {"product", {0, -3}, 1, {-2.54721840378759952L, 0.579148281369033415L}, 0.005L},
      {"product", {0, -3}, 10, {-0.690609507457253471L, -2.40223831310082726L}, 0.002L},
      {"henon_heiles",
       {0, 0.1L, std::sqrt(2.0L / 12 - 0.01L + 0.002L / 3), 0},
       100,
       {0.087110463499681048L, 0.33362404166901964L, 0.259401763088530516L, 0.0133018927609798237L},
       0.02L},
      {"henon_heiles",
       {0, 0.1L, std::sqrt(2.0L / 6 - 0.01L + 0.002L / 3), 0},
       100,
       {-0.529151960964035324L, -0.12307872732645366L, -0.0556781518691067881L,
        0.320569296738868618L},
       0.01L},
      {"double_pendulum",
       {half_pi, half_pi, 0, 0},
       1,
       {1.09477582373490677L, 1.52962312350390186L, -1.94251566969835726L, -1.01067882822914934L},
       0.02L},
      {"double_pendulum",
       {half_pi, half_pi, 0, 0},
       10,
       {1.67912279738244996L, 0.993117806437875829L, -1.11768305603422726L, -0.589228697120611509L},
       0.005L}};
}

std::vector<double> orders(const Reference& reference, const Request& request, long double h) {
  const Emitted emitted = Emitted::shipped(reference.model, request);
  std::vector<long double> errors;
  for (int halved = 0; halved < 3; ++halved, h /= 2) {
    const long long steps = std::llround(reference.t / h);
    errors.push_back(
        distance(emitted.after(steps, reference.start, reference.t / steps), reference.end));
  }
  return observed_orders(errors);
}

TEST(Order, OfTheMidpointRuleIsTwo) {
  for (const Reference& reference : references()) {
    SCOPED_TRACE(reference.model + ", t = " + std::to_string(static_cast<double>(reference.t)));
    for (const double order : orders(reference, {}, reference.h)) EXPECT_NEAR(order, 2.0, 0.1);
  }
}

TEST(Order, OfAGeneralAlphaIsOne) {
  for (const Reference& reference : references()) {
    SCOPED_TRACE(reference.model + ", t = " + std::to_string(static_cast<double>(reference.t)));
    for (const double order : orders(reference, {.alpha = "3/10"}, reference.h / 50)) {
      EXPECT_NEAR(order, 1.0, 0.1);
    }
  }
}

TEST(Pendulum, HasTheEnergySpreadOfThePaper) {
  // q0 = 3.1, h = 0.1, 1e5 steps.
  const Emitted midpoint = Emitted::shipped("pendulum", {});
  const auto energy = midpoint.start({3.1L, 0}, 0.1L).advance(100000, true).energy;
  EXPECT_NEAR(difference(energy->max, energy->min), 1.4987e-6, 0.01 * 1.4987e-6);

  const Emitted tuned =
      Emitted::shipped("pendulum", {.beta = "-2.4978136594e-3*h", .gamma = "-8.33321735568e-2*h"});
  const auto better = tuned.start({3.1L, 0}, 0.1L).advance(100000, true).energy;
  EXPECT_LT(difference(better->max, better->min), 1.3e-12);
}

TEST(Kepler, KeepsItsAngularMomentumOverAMillionSteps) {
  const Emitted kepler = Emitted::shipped("kepler", {});
  runtime::Integrator run = kepler.start({0.4L, 0, 0, 2}, 0.01L);
  long double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(run.advance(1000, false).status, runtime::Status::done);
    const Vector z = state(run);
    worst = std::max(worst, std::abs(z[0] * z[3] - z[1] * z[2] - 0.8L));
  }
  EXPECT_LT(worst, 1e-14L);
}

TEST(Time, AdvancesExactly) {
  // A12: H = p^2/2 + p_t + (1 + 0.2 cos t) q^2/2.
  const Emitted driven = Emitted::shipped("driven_oscillator", {});
  for (const auto& [t, q, p] : {std::tuple{10.0L, -1.03688741508004341L, 0.441253599041630633L},
                                std::tuple{100.0L, 0.404543617238134315L, 1.45929987042748774L}}) {
    std::vector<long double> errors;
    for (long double h = 0.0625L; h > 0.01L; h /= 2) {
      const Vector z = driven.after(std::llround(t / h), {1, 0, 0, 0}, h);
      EXPECT_EQ(z[1], t);  // h is a power of two
      errors.push_back(std::max(std::abs(z[0] - q), std::abs(z[2] - p)));
    }
    for (const double order : observed_orders(errors)) EXPECT_NEAR(order, 2.0, 0.1);
    // With h = 0.1 each sum rounds, and the carry gives it back: one unit in the last place.
    const Vector z = driven.after(std::llround(t * 10), {1, 0, 0, 0}, 0.1);
    EXPECT_NEAR(static_cast<double>(z[1]), static_cast<double>(t), 2e-14);
  }
}

TEST(Scalars, AgreeToTheirRoundOff) {
  const Vector start{0.4L, 0, 0, 2};
  const Vector quad = Emitted::shipped("kepler", {.scalar = "quad"}).after(500, start, 0.0078125L);
  EXPECT_LT(distance(Emitted::shipped("kepler", {}).after(500, start, 0.0078125L), quad), 1e-13L);
  EXPECT_LT(
      distance(Emitted::shipped("kepler", {.scalar = "long-double"}).after(500, start, 0.0078125L),
               quad),
      1e-16L);
  EXPECT_LT(
      distance(Emitted::shipped("kepler", {.scalar = "float"}).after(500, start, 0.0078125L), quad),
      1e-3L);
}

TEST(Fold, ChangesNothingButRoundOff) {
  const Vector plain = Emitted::shipped("pendulum", {}).after(1000, {3.1L, 0}, 0.1L);
  const Vector folded =
      Emitted::shipped("pendulum", {.fold = {"eps"}}).after(1000, {3.1L, 0}, 0.1L);
  // Near the separatrix differences grow by about a thousand within t = 100.
  EXPECT_LT(distance(plain, folded), 1e-11L);
}

TEST(Sweeps, LeaveTheDefectOfSymplecticityOfTheirNumber) {
  // With one sweep, det M - 1 = (h^2 eps/2)(cos qbar - cos q) + (h^2 eps/2)^2 cos q cos qbar; at
  // q = pi/2, p = 0.1 that is -(h^2 eps/2) sin(h p/2).
  auto defect = [](int kappa, long double h) {
    Request request{.solver = "sweeps:" + std::to_string(kappa), .scalar = "long-double"};
    if (kappa == 0) request.solver = "newton";
    const Emitted emitted = Emitted::shipped("pendulum", request);
    const long double d = 0x1p-16L;
    const Vector a = emitted.after(1, {half_pi + d, 0.1L}, h),
                 b = emitted.after(1, {half_pi - d, 0.1L}, h);
    const Vector c = emitted.after(1, {half_pi, 0.1L + d}, h),
                 e = emitted.after(1, {half_pi, 0.1L - d}, h);
    return ((a[0] - b[0]) * (c[1] - e[1]) - (a[1] - b[1]) * (c[0] - e[0])) / (4 * d * d) - 1;
  };
  // Differences leave d^2/6 times third derivatives, eps h and less: 1e-12.
  for (const long double h : {0.1L, 1.0L}) {
    EXPECT_NEAR(static_cast<double>(defect(1, h)),
                static_cast<double>(-(h * h * 0.03L / 2) * std::sin(h * 0.05L)), 1e-11);
  }
  EXPECT_LT(std::abs(defect(0, 1.0L)), 1e-11L);
  EXPECT_GT(std::abs(defect(1, 0.1L)), 7e-7L);
  EXPECT_LT(std::abs(defect(5, 0.7L)), 1e-9L);
}

TEST(Loops, AgreeWithTheWrittenOutSystem) {
  for (const Request& request :
       {Request{.alpha = "0"}, Request{.alpha = "3/10", .beta = "h/7", .gamma = "-h/9"}}) {
    const std::string text =
        "coordinate q[1..64] with q[0] = 0, q[65] = 0\nmomentum p[1..64]\nparameter a = 1/4\n"
        "H = sum(i = 1..64, p[i]^2/2) + sum(i = 0..64, (q[i+1] - q[i])^2/2 + a*(q[i+1] - "
        "q[i])^3/3)\n";
    Request written_out = request;
    written_out.solver = "fixed-point";
    Vector start(128);
    for (int i = 0; i < 64; ++i)
      start[static_cast<std::size_t>(i)] = std::sin(half_pi * 2 * (i + 1) / 65);
    const Vector in_loops = Emitted(text, request).after(100, start, 0.1L);
    EXPECT_LT(distance(in_loops, Emitted(text, written_out).after(100, start, 0.1L)), 1e-12L)
        << request.alpha.text();
  }
}

// Other sums, each with its H as jets: its solution by many sweeps in long double.
using J = Jet<long double>;
using Variables = std::vector<J>;
J square(const J& x) { return x * x; }

struct Sum {
  std::string name;
  std::string text;
  J (*hamiltonian)(const Variables&);
};

const std::vector<Sum>& sums() {
  static const std::vector<Sum> all{
      {"not separable: full Newton",
       "coordinate q[1..26] periodic\nmomentum p[1..26]\n"
       "H = sum(i = 1..26, p[i]^2*(1 + q[i]^2/4)/2 + (1 - cos(q[i+1] - q[i])))\n",
       [](const Variables& z) {
         J h = 0.0L * z[0];
         for (std::size_t i = 0; i < 26; ++i) {
           h = h + 0.5L * (square(z[26 + i]) * (1.0L + 0.25L * square(z[i]))) +
               1.0L * (1.0L + -cos(z[(i + 1) % 26] - z[i]));
         }
         return h;
       }},
      {"periodic: corners in the matrix",
       "coordinate q[1..26] periodic\nmomentum p[1..26]\n"
       "H = sum(i = 1..26, p[i]^2/2 + exp(q[i] - q[i+1]))\n",
       [](const Variables& z) {
         J h = 0.0L * z[0];
         for (std::size_t i = 0; i < 26; ++i) {
           h = h + 0.5L * square(z[26 + i]) + exp(z[i] - z[(i + 1) % 26]);
         }
         return h;
       }},
      {"all pairs: a full matrix",
       "coordinate q[1..26]\nmomentum p[1..26]\nparameter k = 1/16\n"
       "H = (sum(i = 1..26, p[i]^2/2 + q[i]^2/2)"
       " + sum(i = 1..25, sum(j = i+1..26, k*cos(q[i] - q[j]))))\n",
       [](const Variables& z) {
         J h = 0.0L * z[0];
         for (std::size_t i = 0; i < 26; ++i) {
           h = h + 0.5L * square(z[26 + i]) + 0.5L * square(z[i]);
           for (std::size_t j = i + 1; j < 26; ++j) h = h + 0.0625L * cos(z[i] - z[j]);
         }
         return h;
       }},
      {"two arrays, a mass, a linear term",
       "coordinate x[0..12], y[0..12]\nmomentum px[0..12], py[0..12]\nparameter m = 2\n"
       "H = sum(i = 0..12, (px[i]^2 + py[i]^2)/(2*m) + px[i]/8 + x[i]^4/4 + y[i]^2*x[i]/4 + "
       "y[i]^4)\n",
       [](const Variables& z) {
         J h = 0.0L * z[0];
         for (std::size_t i = 0; i < 13; ++i) {
           const J &x = z[i], &y = z[13 + i], &px = z[26 + i], &py = z[39 + i];
           h = h + 0.25L * (square(px) + square(py)) + 0.125L * px + 0.25L * square(square(x)) +
               0.25L * (square(y) * x) + square(square(y));
         }
         return h;
       }}};
  return all;
}

void take_the_step_by_hand(const Sum& sum, const Request& request,
                           const Parameters3<long double>& c) {
  const long double h = 0.03125L;
  Vector z;
  for (std::size_t i = 0; i < 2 * c.alpha.size(); ++i)
    z.push_back(0.3L * std::sin(1.7L * static_cast<long double>(i)));
  for (long double& value : z) value = static_cast<double>(value);
  const Emitted loops(sum.text, request);
  ASSERT_NE(loops.source().solver.find("in loops"), std::string::npos) << loops.source().solver;
  const Vector emitted = loops.after(4, z, h);
  // The map contracts by about h times second derivatives of at most 4: 30 sweeps are plenty.
  for (int i = 0; i < 4; ++i) z = algorithm_1<long double>(sum.hamiltonian, c, h, z, 30);
  EXPECT_LT(distance(emitted, z), 3e-15L);
}

TEST(Loops, AreWhatTheStepByHandIs) {
  const std::size_t n = 26;
  for (const Sum& sum : sums()) {
    SCOPED_TRACE(sum.name);
    take_the_step_by_hand(sum, {}, {Vector(n, 0.5L), Vector(n, 0), Vector(n, 0)});
    take_the_step_by_hand(sum, {.alpha = "3/10", .beta = "1/8", .gamma = "-1/16"},
                          {Vector(n, 0.3L), Vector(n, 0.125L), Vector(n, -0.0625L)});
  }
}

}  // namespace
}  // namespace hamgen::numerics_test
