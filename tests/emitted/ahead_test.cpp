// Derivatives that are evaluated ahead, Note [derivatives ahead] of program/ahead.hpp, in a
// program.
#include <gtest/gtest.h>

#include "generator/base/source_text.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

// Prints nothing unless something is wrong.  With derivatives that are ready a step has the digits
// of one that begins at their point and evaluates them; and a Propagator that has come to steps
// that fail, and begins anew, those of a new one.
constexpr const char* kMain = R"(
#include <cstdio>
using namespace model;
bool same(const State& a, const State& b) { return a.q == b.q && a.p == b.p; }
int main() {
  const Parameters par;
  const Real h = 0.1;
  const State z{1.25, -0.5};
  const State carry{1e-17, -2e-17};
  const Coefficients k = prepare(par, h);
  for (int i = -8; i <= 8; ++i) {
    Start start, other;
    start.known = other.known = true;
    start.value[0] = 1.225 + i * 1e-3;
    Derivatives ready, fresh;
    ready.point[0] = start.value[0];
    derivatives(par, ready);
    ready.ready = true;
    other.value[0] = 7;  // of no consequence
    State dz, dz_ready, rest, rest_ready;
    const StepReport report = solve(par, k, h, z, carry, start, fresh, dz, rest);
    const StepReport report_ready = solve(par, k, h, z, carry, other, ready, dz_ready, rest_ready);
    if (!report.converged || !report_ready.converged) std::puts("no solution");
    if (report.iterations != report_ready.iterations) std::puts("other iterations");
    if (!same(dz, dz_ready) || !same(rest, rest_ready)) std::puts("another step");
    if (start.value[0] != other.value[0]) std::puts("another solution");
    if (fresh.ready || ready.ready) std::puts("taken, and ready again");
  }
  // Beyond q = 2 the root has no value, and the second one runs into it.
  Propagator run(par, h, State{0.5, 0.5});
  if (!run.advance(50).converged) std::puts("the run failed");
  Propagator failing(par, h, State{0.5, 30});
  if (failing.advance(50).converged) std::puts("no failure");
  const State last = failing.state();
  if (failing.step().converged) std::puts("no failure again");
  if (!same(failing.state(), last)) std::puts("the failure moved the state");
  failing.reset(State{0.5, 0.5});
  failing.advance(50);
  if (!same(failing.state(), run.state())) std::puts("not as new");
}
)";

TEST(EmittedAhead, WhatIsReadyHasTheDigitsOfWhatIsEvaluated) {
  const std::string header = emit(make_source("model.ham",
                                              "system model\ncoordinate q\nmomentum p\n"
                                              "H = p^2/2 - cos(q) - sqrt(4 - q^2)/8\n"),
                                  {.name_space = "model"})
                                 .at(0)
                                 .text;
  EXPECT_EQ(count(header, "derivatives ahead"), 1);
  EXPECT_EQ(run_program(without_pragma(header) + kMain), "");
}

}  // namespace
}  // namespace hamgen::emitted_test
