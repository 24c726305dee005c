// Properties a user insists on, by the command.
#include <gtest/gtest.h>

#include "generator/base/diagnostic.hpp"
#include "generator/pipeline.hpp"

namespace hamgen {
namespace {

Request method(const std::string& solver, const std::string& required) {
  return {.solver = solver, .require = required};
}

SourceText kepler() { return read_source(HAMGEN_SOURCE_DIR "/hamiltonians/kepler.ham"); }

TEST(Required, WhatIsProvedIsNoObstacle) {
  const std::string list = "symplectic,symmetric,order:2,conserves:L,emitted-code";
  EXPECT_EQ(generate(kepler(), method("", list)).size(), 1U);
}

TEST(Required, WhatIsRefutedOrOpenStopsTheGeneration) {
  EXPECT_THROW((void)generate(kepler(), method("sweeps:5", "symplectic")), ProofError);
  EXPECT_THROW((void)generate(kepler(), method("", "conserves:A1")), ProofError);
  EXPECT_THROW((void)generate(kepler(), method("", "symplectic,order:3")), ProofError);
  EXPECT_THROW((void)generate(kepler(), method("", "conserves:X")), UsageError);
  EXPECT_THROW((void)generate(kepler(), method("", "fast")), UsageError);
}

TEST(Required, TheHeaderSaysWhatIsProvedAndWhatNot) {
  const std::string solved = generate(kepler(), method("", "")).front().text;
  EXPECT_NE(
      solved.find("//   proved    symplectic, symmetric, order 2, conserves L, emitted code\n"),
      std::string::npos);
  const std::string swept = generate(kepler(), method("sweeps:2", "")).front().text;
  EXPECT_NE(swept.find("//   proved    emitted code\n//   refuted   symplectic, symmetric\n"),
            std::string::npos);
}

}  // namespace
}  // namespace hamgen
