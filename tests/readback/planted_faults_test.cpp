// Faults planted in the text of emitted headers: each is found, at its line.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/readback/planted.hpp"

namespace hamgen::readback_test {
namespace {

TEST(PlantedFault, OfTheTextIsFoundAtItsLine) {
  const Request splitting{.scheme = "stormer-verlet"};
  const std::vector<Fault> faults = {
      {"a - b as a + b", "pendulum", {}, "(p * p) - par.eps", "(p * p) + par.eps"},
      {"parentheses dropped", kRational, {}, "((1.0 + t2) * (par.a", "(1.0 + t2 * (par.a"},
      {"0.5 as 0.25", "kepler", {}, "k.c1 = -0.5 * h", "k.c1 = -0.25 * h"},
      {"sign of the residual", kNonseparable, {}, "{carry.q - q_gap_1", "{carry.q + q_gap_1"},
      {"matrix transposed", kNonseparable, {}, "matrix.put(0, 1,", "matrix.put(1, 0,"},
      {"update subtracted", kNonseparable, {}, "q_bar += delta_q;", "q_bar -= delta_q;"},
      {"dz added twice",
       "pendulum",
       {},
       "two_sum_with_rest(z_.q, carry_.q, dz.q, rest.q);",
       "two_sum_with_rest(z_.q, carry_.q, dz.q, rest.q);\n"
       "    two_sum_with_rest(z_.q, carry_.q, dz.q, rest.q);"},
      {"what is written may be what is read",
       "fput",
       {.scheme = "gauss-4"},
       "Start& __restrict start) {",
       "Start& start) {"},
      {"what is read is promised", "fput", splitting,
       "solve(const Parameters& par, const Coefficients& k, const State& z,",
       "solve(const Parameters& par, const Coefficients& k, const State& __restrict z,"},
      {"sign of the kick", "pendulum", splitting, "dz.p = -k.kick[0]", "dz.p = k.kick[0]"},
      {"a number of the tableau",
       "pendulum",
       {.scheme = "gauss-6"},
       "0.96475800154489;",
       "0.96475800154488;"},
      {"all substeps of the first's length",
       "pendulum",
       {.scheme = "yoshida-4"},
       "lengths_[i] = h * fractions[i];",
       "lengths_[i] = h * fractions[0];"},
      {"q and p exchanged", "pendulum", {}, "const Real q = z.q;", "const Real q = z.p;"},
      {"derivatives that are ready, at another point",
       "pendulum",
       {},
       "if (at.ready) q_bar = at.point[0];",
       "if (at.ready) q_bar = start.value[0];"},
      {"taken by every iteration", "pendulum", {}, "at.ready = false;", "at.ready = true;"},
      {"evaluated where the last step was",
       "pendulum",
       {},
       "extrapolate_twice(history_, at_.point);",
       "history_.extrapolate(at_.point);"},
      {"index of the solution", kNonseparable, {}, "delta_r = vector[1];", "delta_r = vector[2];"},
      {"stops at 1e9 eps",
       kNonseparable,
       {},
       "round_off = epsilon * scale;",
       "round_off = 1e9 * epsilon * scale;"},
      {"lengths h^2", "pendulum", splitting, "k.kick[0] = 0.5 * h;", "k.kick[0] = 0.5 * h * h;"},
      {"a/(b*c) as a/b*c",
       kRational,
       {},
       "t2 / ((1.0 + t2) * (par.a + q * t1))",
       "t2 / (1.0 + t2) * (par.a + q * t1)"},
      {"sin as cos",
       "pendulum",
       {},
       "H_q = par.eps * std::sin(q_bar)",
       "H_q = par.eps * std::cos(q_bar)"},
      {"value of an event",
       kWithEvents,
       {.events = true},
       "values[0] = -(par.line - q);",
       "values[0] = par.line - q;"},
      {"direction of an event",
       kWithEvents,
       {.events = true},
       "falling[events] = {false, true}",
       "falling[events] = {true, true}"},
      {"names of events exchanged",
       kWithEvents,
       {.events = true},
       "right,\n  top,",
       "top,\n  right,"},
      {"derivative on the cubic", kWithEvents, {.events = true}, "-at_a[0]", "at_a[0]"},
      {"part of a step as a step",
       kWithEvents,
       {.events = true},
       "theta * propagator_.h(), before_",
       "propagator_.h(), before_"},
      {"a block that looks for events",
       kWithEvents,
       {.events = true},
       "const bool rises = at_low < 0 &&",
       "const bool rises = at_low > 0 &&"},
  };
  EXPECT_EQ(faults.size(), 27U);
  for (const Fault& fault : faults) expect_found(fault);
}

TEST(PlantedFault, OfRoundingAloneIsFound) {
  const std::vector<Fault> faults = {
      {"carry dropped",
       "pendulum",
       {},
       "two_sum_with_rest(z_.p, carry_.p, dz.p, rest.p);",
       "z_.p += dz.p + rest.p;"},
      {"order of a sum",
       "henon_heiles",
       {},
       "q2_bar + q1_bar * q1_bar - q2_bar * q2_bar",
       "q2_bar + (q1_bar * q1_bar - q2_bar * q2_bar)"},
      {"order of a product",
       "pendulum",
       {},
       "start.value[0] = q_bar + delta_q;",
       "start.value[0] = delta_q + q_bar * 1.0;"},
      {"last digit", "pendulum", {.alpha = "3/10"}, "k.c1 = ", "k.c1 = 1.0000000000000002 * "},
      {"another type", "pendulum", {.scalar = "float"}, "0.5f * (p * p)", "0.5 * (p * p)"},
      {"carry not collected",
       "pendulum",
       {.scheme = "stormer-verlet"},
       "collect(dz.p, rest.p, -k.kick[1] * start.value[0]);",
       "dz.p += -k.kick[1] * start.value[0];"},
      {"two-sum without its rest",
       "pendulum",
       {},
       "carry = (value - (sum - part)) + (increment - part);",
       "carry = increment - part;"},
      {"fast arithmetic allowed",
       "pendulum",
       {},
       "#pragma clang fp reassociate(off)",
       "#pragma clang fp reassociate(on)"},
  };
  for (const Fault& fault : faults) expect_found(fault);
}

TEST(ReadBackOf, ATextThatComputesTheSameIsTheSame) {
  const Emitted header = emitted("pendulum", {});
  const std::vector<std::pair<std::string, std::string>> freedoms = {
      {"par.eps * std::sin(q_bar)", "std::sin((q_bar)) * par.eps"},
      {"0.5 * (p * p) - par.eps * std::cos(q)", "-par.eps * std::cos(q) + p * p * 0.5e0"},
      {"k.c1 = -0.5 * h;", "k.c1 = -(h * 0x1p-1);  // half"},
      {"const Real q = z.q;\n", "/* q */ Real\n  q=z.q;\n"},
      {"delta_q = -R_q / R_q_q;", "delta_q = -(R_q / R_q_q);"},
      {"rest.p = carry.p - h * change_H_q;", "rest.p = carry.p + -change_H_q * h;"},
  };
  for (const auto& [from, to] : freedoms) {
    std::string changed = header.text;
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    changed.replace(at, from.size(), to);
    const ReadBack found = header.read(changed);
    EXPECT_EQ(found.outcome, ReadBack::Outcome::same) << to << ": " << found.line << found.what;
  }
}

// A local called otherwise, everywhere.
TEST(ReadBackOf, NamesOfLocalsAreFree) {
  const Emitted header = emitted("pendulum", {});
  std::string changed = header.text;
  for (std::size_t at = 0; (at = changed.find("rest_p", at)) != std::string::npos; at += 4)
    changed.replace(at, 6, "push");
  EXPECT_EQ(header.read(changed).outcome, ReadBack::Outcome::same);
  // ... but not where two become one.
  changed = header.text;
  const std::size_t at = changed.find("const Real change_H_p = ");
  changed.replace(at, 21, "const Real change_H_q");
  EXPECT_NE(header.read(changed).outcome, ReadBack::Outcome::same);
}

TEST(ReadBackOf, WhatIsNotUnderstoodIsNotProved) {
  const Emitted header = emitted("pendulum", {});
  const std::string from = "k.c1 = -0.5 * h;";
  const std::size_t at = header.text.find(from);
  for (const char* to : {"k.c1 = [&] { return -0.5 * h; }();", "while (true) { k.c1 = -0.5 * h; }",
                         "k.c1 = -0.5 * h ^ 1;", "goto end; k.c1 = -0.5 * h;"}) {
    std::string changed = header.text;
    changed.replace(at, from.size(), to);
    const ReadBack found = header.read(changed);
    EXPECT_NE(found.outcome, ReadBack::Outcome::same) << to;
    EXPECT_GT(found.line, 0);
  }
  std::string deep = header.text;
  deep.replace(at, from.size(), "k.c1 = " + std::string(100000, '(') + "h;");
  EXPECT_EQ(header.read(deep).outcome, ReadBack::Outcome::not_understood);
  // Long chains are neither a matter of minutes nor of the stack.
  for (const char* chain : {"h + ", "h * h - ", "h = "}) {
    std::string formula;
    for (int i = 0; i < 100000; ++i) formula += chain;
    std::string longer = header.text;
    longer.replace(at, from.size(), "k.c1 = " + formula + "h;");
    EXPECT_EQ(header.read(longer).outcome, ReadBack::Outcome::not_understood) << chain;
  }
  EXPECT_NE(header.read("").outcome, ReadBack::Outcome::same);
}

// A comment that swallows the next line for a compiler: nothing of it may be taken for code.
TEST(ReadBackOf, CommentsThatGoOnAreNotUnderstood) {
  const Emitted header = emitted("pendulum", {});
  const std::string from = "  two_sum_with_rest(z_.q, carry_.q, dz.q, rest.q);";
  for (const char* before :
       {"// \\\n", "// \\ \t\n", "// \\\r\n", "// ?\?/\n", "/* *\\\n/ z_.q = 0; /* */",
        "/* *\\ \n/ z_.q = 0; /* */", "// \rz_.q = 0;\n"}) {
    std::string changed = header.text;
    changed.insert(changed.find(from), before);
    EXPECT_EQ(header.read(changed).outcome, ReadBack::Outcome::not_understood) << before;
  }
  std::string changed = header.text;
  const std::string directive = "#endif\n";
  changed.replace(changed.find(directive), directive.size(), "#endif  // \\\n");
  EXPECT_EQ(header.read(changed).outcome, ReadBack::Outcome::not_understood);
}

TEST(ReadBackOf, EveryWordCounts) {
  expect_every_word_counts(emitted("pendulum", {}), 7);
  expect_every_word_counts(emitted("fput", {.solver = "fixed-point"}), 29);
  expect_every_word_counts(emitted("kepler", {.scheme = "gauss-4"}), 29);
}

}  // namespace
}  // namespace hamgen::readback_test
