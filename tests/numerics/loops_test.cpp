// Systems whose sums stay loops against the step by hand, for every kind of matrix and iteration.
#include <gtest/gtest.h>

#include "tests/numerics/dense_step.hpp"
#include "tests/numerics/emitted_run.hpp"

namespace hamgen::numerics_test {
namespace {

using LongJet = Jet<long double>;
using Jets = std::vector<LongJet>;
constexpr std::size_t kRing = 26;
constexpr std::size_t kBodies = 13;

LongJet square_of_long(const LongJet& a) { return a * a; }

// A ring with forces of third degree, its masses 1, 3/2, 2, 1, ... if `masses`, and a kinetic
// energy with a term of first degree.
std::string ring_text(bool masses) {
  std::string list;
  for (std::size_t i = 0; i < kRing; ++i) {
    list += (i == 0 ? "" : ", ") + std::to_string(2 + i % 3) + "/2";
  }
  return "size N = 26\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n" +
         (masses ? "parameter m[1..N] = [" + list + "]\n" : "") + "H = sum(i = 1..N, p[i]^2/" +
         (masses ? "(2*m[i])" : "2") +
         " + p[i]/8 + (q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^4/4 + q[i]^4/4)\n";
}
LongJet ring(const Jets& z, bool masses) {
  LongJet sum = 0.0L * z[0];
  for (std::size_t i = 0; i < kRing; ++i) {
    const long double m = masses ? static_cast<long double>(2 + i % 3) / 2 : 1;
    const LongJet s = square_of_long(z[(i + 1) % kRing] - z[i]);
    sum = sum + 0.5L / m * square_of_long(z[kRing + i]) + 0.125L * z[kRing + i] + 0.5L * s +
          0.25L * square_of_long(s) + 0.25L * square_of_long(square_of_long(z[i]));
  }
  return sum;
}

// Every body in the plane repels every other.
const char* const kPairs =
    "size N = 13\ncoordinate x[1..N]\ncoordinate y[1..N]\nmomentum px[1..N]\nmomentum py[1..N]\n"
    "H = sum(i = 1..N, (px[i]^2 + py[i]^2)/2) + sum(i = 1..N-1, j = i+1..N,\n"
    "    1/(1 + (x[i] - x[j])^2 + (y[i] - y[j])^2))\n";
LongJet pairs(const Jets& z) {
  LongJet sum = 0.0L * z[0];
  for (std::size_t i = 0; i < 2 * kBodies; ++i)
    sum = sum + 0.5L * square_of_long(z[2 * kBodies + i]);
  for (std::size_t i = 0; i < kBodies; ++i) {
    for (std::size_t j = i + 1; j < kBodies; ++j) {
      const LongJet d =
          1.0L + (square_of_long(z[i] - z[j]) + square_of_long(z[kBodies + i] - z[kBodies + j]));
      sum =
          sum + d.through(1 / d.value, -1 / (d.value * d.value), 2 / (d.value * d.value * d.value));
    }
  }
  return sum;
}

// A ring that is not separable, and couples the momenta.
const char* const kCoupledLoops =
    "size N = 26\ncoordinate q[1..N] periodic\nmomentum p[1..N] periodic\n"
    "H = sum(i = 1..N, (q[i]^2 + p[i]^2)^2/4 + q[i]*q[i+1] + p[i]*p[i+1])\n";
LongJet coupled(const Jets& z) {
  LongJet sum = 0.0L * z[0];
  for (std::size_t i = 0; i < kRing; ++i) {
    const std::size_t next = (i + 1) % kRing;
    sum = sum + 0.25L * square_of_long(square_of_long(z[i]) + square_of_long(z[kRing + i])) +
          z[i] * z[next] + z[kRing + i] * z[kRing + next];
  }
  return sum;
}

Vector some_state() {
  Vector z;
  for (std::size_t i = 0; i < 2 * kRing; ++i) {
    z.push_back(static_cast<long double>(static_cast<double>(std::sin(7.0L * (i + 1)))));
  }
  return z;
}

constexpr long double kLoopStep = 0.0625L;

// The largest distance after five steps by Newton's method.  An iteration ends within the rounding
// of all its components together, 52 of size below 2, and the conditions of these systems are below
// 2 at this step size: 5 * 52 * 2 * 2 * 2^-53 = 1.2e-13.
constexpr long double kBound = 1.2e-13L;

template <class Hamiltonian>
void compare(const std::string& text, Request request, const Hamiltonian& hamiltonian,
             long double alpha, long double beta, long double gamma, const std::string& solver) {
  const Emitted loops(text, request);
  EXPECT_NE(loops.source().text.find("in loops"), std::string::npos);
  EXPECT_NE(loops.source().text.find(solver), std::string::npos);
  const std::size_t n = some_state().size() / 2;
  const Parameters3<long double> member{Vector(n, alpha), Vector(n, beta), Vector(n, gamma)};
  Vector expected = some_state();
  for (int i = 0; i < 5; ++i) {
    expected = request.solver == "sweeps:3"
                   ? algorithm_1(hamiltonian, member, kLoopStep, expected, 3)
                   : dense_step(hamiltonian, member, kLoopStep, expected);
  }
  const Vector found = loops.after(5, some_state(), kLoopStep);
  EXPECT_LT(distance(found, expected), kBound) << text;
  // One step more is another state.
  EXPECT_GT(distance(loops.after(6, some_state(), kLoopStep), expected), 1e-3L);
}

auto uniform_ring = [](const Jets& z) { return ring(z, false); };
auto ring_of_masses = [](const Jets& z) { return ring(z, true); };

const Request kGeneral{.alpha = "3/10", .beta = "h/7", .gamma = "-h/9"};

TEST(Loops, ARingIsFoldedIntoABand) {
  compare(ring_text(false), {}, uniform_ring, 0.5L, 0, 0, "banded Newton of size 26");
  compare(ring_text(false), kGeneral, uniform_ring, 0.3L, kLoopStep / 7, -kLoopStep / 9,
          "banded Newton of size 26");
}

TEST(Loops, MassesThatDifferAreAnArray) {
  compare(ring_text(true), {}, ring_of_masses, 0.5L, 0, 0, "banded Newton of size 26");
  compare(ring_text(true), kGeneral, ring_of_masses, 0.3L, kLoopStep / 7, -kLoopStep / 9,
          "banded Newton of size 26");
}

TEST(Loops, EveryPairOfBodiesIsADenseMatrix) {
  compare(kPairs, {}, pairs, 0.5L, 0, 0, "dense Newton of size 26");
}

TEST(Loops, WhatIsNotSeparableIsABandOfCoordinatesAndMomentaInTurn) {
  compare(kCoupledLoops, {}, coupled, 0.5L, 0, 0, "banded Newton of size 52");
  compare(kCoupledLoops, kGeneral, coupled, 0.3L, kLoopStep / 7, -kLoopStep / 9,
          "banded Newton of size 52");
}

TEST(Loops, ADefinitionMayHoldASum) {
  const std::string head = "size N = 26\ncoordinate q[1..N]\nmomentum p[1..N]\n";
  const std::string kinetic = "H = sum(i = 1..N, p[i]^2/2";
  const Request explicit_step{.alpha = "0"};
  Vector start(52);
  for (std::size_t i = 0; i < start.size(); ++i)
    start[i] = static_cast<long double>(i % 7) / 8 - static_cast<long double>(i % 3) / 4;
  const Vector wanted =
      Emitted(head + kinetic + ") + sum(i = 1..N, j = 1..N, q[i]*q[j]/N)\n", explicit_step)
          .after(3, start, 0.1L);
  for (const char* rest : {"let M = sum(j = 1..N, q[j])/N\nK + q[i]*M)\n",
                           "let M = sum(i = 1..N, q[i])/N\nK + q[i]*M)\n",  // the same index
                           "let M = sum(k = 1..N, q[k])\nK) + M^2/N\n",
                           "let M = 2*sum(k = 1..N, j = 1..N, q[k]*q[j])\nK) + M/(2*N)\n"}) {
    std::string text = rest;
    text.replace(text.find("\nK") + 1, 1, kinetic);
    EXPECT_LT(distance(Emitted(head + text, explicit_step).after(3, start, 0.1L), wanted), 1e-14L)
        << text;
  }
}

TEST(Loops, TheFixedPointIsTheSolutionOfNewtonsMethod) {
  Request request{.solver = "fixed-point"};
  compare(ring_text(true), request, ring_of_masses, 0.5L, 0, 0, "fixed point of size 26");
  compare(kCoupledLoops, request, coupled, 0.5L, 0, 0, "fixed point of size 52");
  request = kGeneral;
  request.solver = "fixed-point";
  compare(ring_text(true), request, ring_of_masses, 0.3L, kLoopStep / 7, -kLoopStep / 9,
          "fixed point of size 26");
}

TEST(Loops, SweepsAreThePapersAlgorithm) {
  Request request{.solver = "sweeps:3"};
  compare(ring_text(true), request, ring_of_masses, 0.5L, 0, 0, "3 fixed-point sweeps");
  request = kGeneral;
  request.solver = "sweeps:3";
  compare(kCoupledLoops, request, coupled, 0.3L, kLoopStep / 7, -kLoopStep / 9,
          "3 fixed-point sweeps");
}

}  // namespace
}  // namespace hamgen::numerics_test
