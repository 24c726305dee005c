// --plain-sums: no carry anywhere, and everything that is proved of a step still is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "generator/interpreter/interpreter.hpp"
#include "generator/stages.hpp"
#include "generator/verify/proof.hpp"
#include "tests/verify/mutants.hpp"

namespace hamgen::verify_test {
namespace {

const std::string kPlainPendulum =
    "coordinate q\nmomentum p\nparameter eps = 0.03\nH = p^2/2 - eps*cos(q)\n";
const std::string kPlainProduct = "coordinate q\nmomentum p\nH = (q^2 + 1)*(p^2 + 1)/2\n";
const std::string kOscillator = "coordinate q\nmomentum p\nH = p^2/2 + 169/200*q^2\n";
const std::string kChain =
    "size N = 26\ncoordinate x[1..N] with x[0] = 0, x[N+1] = 0\nmomentum p[1..N]\n"
    "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (x[i+1] - x[i])^2/2 + (x[i+1] - x[i])^3/12)\n";

// One of each kind of a step, for both storages.
const std::vector<Request> kMethods = {
    {},
    {.solver = "fixed-point"},
    {.solver = "sweeps:2"},
    {.alpha = "0"},
    {.alpha = "2/3", .beta = "h/7"},
    {.scheme = "stormer-verlet"},
    {.scheme = "yoshida-4"},
    {.scheme = "gauss-4"},
    {.scheme = "gauss-4", .solver = "newton"},
    {.scheme = "rk4"},
};

std::string name_of(const Request& request) {
  return request.scheme.text() + request.solver.text() + request.alpha.text() + request.beta.text();
}

TEST(PlainSums, AreProvedAndNameNoCarry) {
  for (const std::string& text : {kPlainPendulum, kPlainProduct, kOscillator, kChain}) {
    const SourceText source = make_source("m.ham", text);
    for (Request request : kMethods) {
      if (text == kPlainProduct && request.scheme == "stormer-verlet") continue;
      request.plain_sums = true;
      request.tangent = text != kChain;
      const Stages stages = run_stages(source, request);
      const Proof proof = verify_step(source, request);
      for (const char* property : {"program", "emitted code"}) {
        const auto found = std::ranges::find(proof, property, &Finding::property);
        ASSERT_NE(found, proof.end());
        EXPECT_EQ(found->verdict, Verdict::proved)
            << text << name_of(request) << ": " << found->detail;
      }
      EXPECT_EQ(to_text(stages.program).find("carry"), std::string::npos);
      const std::string header =
          generate_plugin(source, request, HeaderText::without_proof).header.text;
      for (const char* word : {"carry", "two_sum", "collect(", "rest."})
        EXPECT_EQ(header.find(word), std::string::npos) << name_of(request) << " " << word;
      EXPECT_NE(header.find("compensated sums"), std::string::npos);
    }
  }
}

TEST(PlainSums, InCToo) {
  const SourceText source = make_source("m.ham", kPlainPendulum);
  for (const char* scheme : {"implicit-midpoint", "stormer-verlet", "yoshida-4"}) {
    const OutputFiles files =
        generate(source, {.scheme = scheme, .format = "c-header", .plain_sums = true});
    for (const char* word : {"carry", "two_sum", "collect"})
      EXPECT_EQ(files.front().text.find(word), std::string::npos) << scheme << " " << word;
  }
}

// What is small of an increment belongs to it: left out, the step is another.
TEST(PlainSums, WithoutTheSmallPartOfAnIncrementAreRefuted) {
  const SourceText source = make_source("m.ham", kPlainPendulum);
  for (const char* solver : {"", "fixed-point"}) {
    Stages stages = run_stages(source, {.solver = solver, .plain_sums = true});
    Program code = stages.program;
    const Mechanics& mechanics = stages.system.mechanics;
    const Scheme& scheme = stages.equations.scheme;
    const auto finding = [&] {
      return prove_emitted(mechanics, scheme, stages.plan, code, mechanics.energy);
    };
    EXPECT_EQ(finding().verdict, Verdict::proved);
    bool changed = false;
    for (Routine& routine : code.routines) {
      if (routine.name != "solve") continue;
      for (Instruction& instruction : routine.body) {
        auto* assign = std::get_if<Assign>(&instruction.value);
        if (assign == nullptr || assign->symbol != "dz.p") continue;
        const auto [coefficient, sum] = assign->value.split_coefficient();
        ASSERT_EQ(sum.kind(), Kind::sum);
        assign->value = Expression(coefficient) * sum.operands()[0];
        changed = true;
      }
    }
    EXPECT_TRUE(changed);
    EXPECT_EQ(finding().verdict, Verdict::refuted) << solver;
  }
}

// What they are for, and what they cost: after 20000 steps states have lost digits that the
// compensated ones have, in the mean of some starts.
TEST(PlainSums, LoseWhatRoundingTakes) {
  const SourceText source = make_source("m.ham", kPlainPendulum);
  const auto error_of = [&](bool plain) {
    const Program code = make_program(source, {.plain_sums = plain});
    double sum = 0;
    for (const double q : {1.3, 0.9, 0.5, 1.7}) {
      Interpreter<double> run(code, {0.03}, 0.1, {q, 0.0});
      Interpreter<__float128> exact(code, {__float128(0.03)}, __float128(0.1), {q, 0});
      for (int step = 0; step < 20000; ++step) {
        if (!run.step().converged || !exact.step().converged) return HUGE_VAL;
      }
      sum += std::abs(static_cast<double>(run.state()[0] - exact.state()[0]));
    }
    return sum / 4;
  };
  const double compensated = error_of(false);
  const double plain = error_of(true);
  EXPECT_LE(compensated, 1e-13);
  EXPECT_GE(plain, 3 * compensated) << plain << " " << compensated;
  EXPECT_LE(plain, 1e-11);  // and no step has failed
}

}  // namespace
}  // namespace hamgen::verify_test
