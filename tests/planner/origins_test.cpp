// What the lines of a step are there for: Note [origins] in generator/program/origins.hpp.
#include <gtest/gtest.h>

#include "generator/base/source_text.hpp"
#include "generator/pipeline.hpp"

namespace hamgen {
namespace {

// From the first of the two lines on, up to the other.
std::string between(const std::string& text, const std::string& first, const std::string& other) {
  const auto begin = text.find(first);
  const auto end = text.find(other, begin);
  if (begin == std::string::npos || end == std::string::npos) return "not found in\n" + text;
  return text.substr(begin, end - begin);
}

std::string origins(const std::string& model, const Request& request = {}) {
  return show_stage(make_source("test.ham", model), request, "origins");
}

constexpr const char* kTwoForces = R"(system two_forces
coordinate q
momentum p
parameter w = 2
parameter c = 1
H = (p^2/2
  + w^2*q^2/2
  - c*cos(q))
)";

TEST(Origins, AreTheTermsOfHInTheirLines) {
  EXPECT_EQ(between(origins(kTwoForces), "H is", "record"),
            "H is the sum of the terms\n"
            "  1  line 6: p^2/2\n"
            "  2  line 7: w^2*q^2/2\n"
            "  3  line 8: -c*cos(q)\n");
}

TEST(Origins, OfDerivativesAreTheTermsWithTheirVariables) {
  EXPECT_EQ(between(origins(kTwoForces), "solve(", "  return"),
            R"(solve(par, k, h, z, carry, &start, &at, &dz, &rest):
step                  |  q = z.q
step                  |  p = z.p
step                  |  iterate with Newton's rule:
iteration             |    if at.ready:
iteration             |      bar(q) <- at.point[0]
iteration             |    if not at.ready:
iteration             |      at.point[0] <- bar(q)
iteration             |      derivatives(par, k, at)
iteration             |    at.ready <- false
iteration H 2 3       |    rest(beside p) = carry(p) + #1*H(q)
iteration H 2 3       |    rest(p) = rest(beside p) + #2*H(q)
iteration H 2 3       |    bar(p) = p + rest(p)
iteration H 2 3       |    d(p)/d(q) = #3*H(q,q)
iteration             |    q gap = bar(q) - q
iteration             |    q gap 1 = q gap + bar(p)*#2
iteration             |    rest(beside q) = carry(q) + bar(p)*#4
iteration             |    R(q) = q gap 1 - rest(beside q)
iteration H 2 3       |    R(q,q) = 1 + #3*d(p)/d(q)
iteration H 2 3       |    delta(q) = -R(q)/R(q,q)
                      |    correct bar(q) by delta(q), from q
step      H 2 3       |  change(H(q)) = delta(q)*H(q,q)
step      H 2 3       |  change(H(p)) = #3*change(H(q))
step                  |  rest(moving q) = carry(q) + bar(p)*low(h)
step      H 2 3       |  rest(moving p) = carry(p) - H(q)*low(h)
step      H 1         |  dz.q <- bar(p)*high(h)
step      H 1         |  rest.q <- rest(moving q) + h*change(H(p))
step      H 2 3       |  dz.p <- -H(q)*high(h)
step      H 2 3       |  rest.p <- rest(moving p) - h*change(H(q))
step                  |)");
}

// A change of h leaves alone what depends on parameters alone.
TEST(Origins, TellCoefficientsOfTheRunFromThoseOfTheStepSize) {
  EXPECT_EQ(between(origins(kTwoForces), "prepare(", "solve("),
            R"(prepare(par, h):
run                   |  #0 <- w^2
run                   |  high(w^2) <- 9999*#0/10000
run                   |  low(w^2) <- #0 - high(w^2)
step size             |  high(h) <- 9999*h/10000
step size             |  low(h) <- h - high(h)
step size             |  #1 <- -low(h)/2
step size             |  #2 <- -high(h)/2
step size             |  #3 <- -h/2
step size             |  #4 <- low(h)/2
derivatives(par, k, &at):
iteration             |  bar(q) = at.point[0]
iteration H 2 3       |  H(q) = c*sin(bar(q)) + bar(q)*high(w^2) + bar(q)*low(w^2)
iteration H 2 3       |  H(q,q) = #0 + c*cos(bar(q))
iteration H 2 3       |  at.H_q <- H(q)
iteration H 2 3       |  at.H_q_q <- H(q,q)
)");
}

TEST(Origins, OfLoopsAreTheTermsOfTheirKernels) {
  const std::string chain = origins(R"(system chain
size N = 40
coordinate q[1..N] with q[0] = 0, q[N+1] = 0
momentum p[1..N]
H = (sum(i = 1..N, p[i]^2/2) + sum(i = 1..N, q[i]^4)
  + sum(i = 0..N, (q[i+1] - q[i])^2/2))
)");
  EXPECT_EQ(between(chain, "potential_gradient(", "prepare("),
            R"(potential_gradient(par, q, &dq):
iteration             |  for i = 1..40:
iteration H 2         |    q[i] = at q[i - 1]
iteration H 2         |    #0 = q[i]^2
iteration H 2         |    dq(i - 1) <- 4*q[i]*#0
iteration             |  for i = 2..39:
iteration H 3         |    q[i] = at q[i - 1]
iteration H 3         |    q[i-1] = at q[i - 2]
iteration H 3         |    q[i+1] = at q[i]
iteration H 3         |    dq(i - 1) += -(q[i-1] - q[i])
iteration H 3         |    dq(i - 1) += q[i] - q[i+1]
iteration             |  scope:
iteration H 3         |    q[2] = at q[1]
iteration H 3         |    q[1] = at q[0]
iteration H 3         |    dq(0) += q[1] - q[2]
iteration             |  scope:
iteration H 3         |    q[40] = at q[39]
iteration H 3         |    q[39] = at q[38]
iteration H 3         |    dq(39) += -(q[39] - q[40])
iteration             |  scope:
iteration H 3         |    q[1] = at q[0]
iteration H 3         |    q[40] = at q[39]
iteration H 3         |    dq(0) += q[1]
iteration H 3         |    dq(39) += q[40]
)");
  // What is no routine of its own has its term where it stands.
  EXPECT_NE(chain.find("iteration H 1         |    start.slope[i + 40] <- p[i]\n"),
            std::string::npos)
      << chain;
}

}  // namespace
}  // namespace hamgen
