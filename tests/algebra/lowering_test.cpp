// From definitions to statements: what is shared, what is hoisted.
#include <gtest/gtest.h>

#include "generator/base/source_text.hpp"
#include "generator/pipeline.hpp"

namespace hamgen {
namespace {

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

// The body of the loop of the emitted step.
std::string loop(const std::string& hamiltonian, const Request& request = {}) {
  const std::string header =
      generate(make_source("small.ham",
                           "system small\ncoordinate q1, q2\nmomentum p1, p2\n" + hamiltonian),
               request)[0]
          .text;
  const auto begin = header.find("for (int iteration");
  return header.substr(begin, header.find("const Real size", begin) - begin);
}

TEST(Lowering, KeplerHasOneSquareRootAndOneReciprocalOfItAnIteration) {
  const std::string body = loop("H = (p1^2 + p2^2)/2 - 1/sqrt(q1^2 + q2^2)\n");
  EXPECT_EQ(count(body, "sqrt("), 1) << body;
  // 1/r^2, 1/r and all higher powers from one division; one more for the 2x2 solve.
  EXPECT_LE(count(body, " / "), 2) << body;
  EXPECT_EQ(count(body, "pow("), 0) << body;
}

TEST(Lowering, PowersAreProducts) {
  const std::string body = loop("H = (p1^2 + p2^2)/2 + (q1 + q2)^9 + (q1 + q2)^4\n");
  EXPECT_EQ(count(body, "pow("), 0) << body;
  EXPECT_EQ(count(body, "q1_bar + q2_bar"), 1) << "the base is one temporary\n" << body;
}

TEST(Lowering, SinesOfOneAngleAreComputedOnce) {
  const std::string body =
      loop("H = (p1^2 + p2^2)/2 + sin(q1 - q2)^2 + cos(q2 - q1)*sin(q1 - q2) - cos(q1 - q2)\n");
  EXPECT_EQ(count(body, "std::sin("), 1) << body;
  EXPECT_EQ(count(body, "std::cos("), 1) << body;
}

TEST(Lowering, WhatDependsOnParametersAloneLeavesTheLoop) {
  const std::string body = loop(
      "parameter a = 2\nparameter b = 3\nH = (p1^2 + p2^2)/2 - sqrt(a^3 + b)/exp(b)*cos(q1*q2)\n");
  EXPECT_EQ(count(body, "par.a"), 0) << body;
  EXPECT_EQ(count(body, "std::exp("), 0) << body;
  EXPECT_EQ(count(body, "std::sqrt("), 0) << body;
}

}  // namespace
}  // namespace hamgen
