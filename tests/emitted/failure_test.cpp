// A step that fails says so and changes nothing.
#include <gtest/gtest.h>

#include "generator/base/source_text.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

std::string header(const std::string& text, Request request) {
  request.name_space = "model";
  return emit(make_source("model.ham", "system model\n" + text), request).at(0).text;
}

// Steps until one fails; prints nothing unless something is wrong.
// With several states, "{1, 0}, {2, 0}", or step sizes, "0.1, 0.2", each of them in turn.
enum class Expected { failure, success, either };
std::string program(const std::string& header_text, const std::string& state, const std::string& h,
                    Expected expected) {
  return without_pragma(header_text) +
         "#include <cstdio>\n#include <cstring>\n#include <initializer_list>\n"
         "bool same(const model::State& a, const model::State& b) {\n"
         "  return std::memcmp(&a, &b, sizeof a) == 0;\n}\n"
         "bool finite(const model::State& z) {\n"
         "  for (const model::Real x : {" +
         [&] {
           std::string list;
           for (const char* name : {"q", "p"})
             list += (list.empty() ? "z." : ", z.") + std::string(name);
           return list;
         }() +
         "}) if (!(x - x == 0)) return false;\n  return true;\n}\n"
         "int main() {\n"
         "  const model::Parameters par;\n"
         "  for (const double size : {" +
         h +
         "}) {\n"
         "  const model::Real h = static_cast<model::Real>(size);\n"
         "  for (const model::State& start : std::initializer_list<model::State>{" +
         state +
         "}) {\n"
         "  bool failed = false;\n"
         "  model::State z = start;\n"
         "  for (int i = 0; i < 1000 && !failed; ++i) {\n"
         "    const model::State before = z;\n"
         "    const model::StepReport report = model::step(par, h, z);\n"
         "    failed = !report.converged;\n"
         "    if (failed && !same(before, z)) std::puts(\"step changed the state\");\n"
         "    if (!finite(z)) { std::puts(\"step gave a state that is not finite\"); break; }\n"
         "  }\n"
         "  model::Propagator run(par, h, start);\n"
         "  bool run_failed = false;\n"
         "  for (int i = 0; i < 1000 && !run_failed; ++i) {\n"
         "    const model::State before = run.state();\n"
         "    run_failed = !run.step().converged;\n"
         "    if (run_failed && !same(before, run.state())) std::puts(\"the propagator changed "
         "it\");\n"
         "    if (!finite(run.state())) { std::puts(\"propagator not finite\"); break; }\n"
         "  }\n"
         "  const int outcome = (failed ? 1 : 2) | (run_failed ? 1 : 2);\n"
         "  if ((outcome & " +
         (expected == Expected::failure   ? "2"
          : expected == Expected::success ? "1"
                                          : "0") +
         ") != 0) std::puts(\"not the expected outcome\");\n  }\n  }\n}\n";
}

const std::string collapse = "coordinate q\nmomentum p\nparameter g = -1\nH = p^2/2 + g/q^2\n";
const std::string pendulum_text = "coordinate q\nmomentum p\nH = p^2/2 - cos(q)\n";

TEST(Failure, OfACollapseLeavesTheStateAsItWas) {
  // q(t)^2 = 1 - 2 t^2: singular at t = 0.7071.  A step may land beyond q = 0, in one scalar or
  // another; in double some step near it finds no solution.
  EXPECT_EQ(run_program(program(header(collapse, {}), "{1, 0}", "0.01", Expected::failure)), "");
  for (const char* scalar : {"float", "long-double", "quad"}) {
    EXPECT_EQ(run_program(program(header(collapse, {.scalar = scalar}), "{1, 0}", "0.01",
                                  Expected::either)),
              "")
        << scalar;
  }
}

TEST(Failure, OfAnOverflowLeavesTheStateAsItWas) {
  const std::string escape = "coordinate q\nmomentum p\nH = p^2/2 - q^4\n";
  for (const Request& request :
       {Request{.alpha = "0"}, Request{.alpha = "1"}, Request{.solver = "sweeps:3"}}) {
    EXPECT_EQ(run_program(program(header(escape, request), "{1, 1}", "0.1", Expected::failure)),
              "");
  }
  // An implicit equation may have other solutions that stay.
  for (const Request& request : {Request{}, Request{.solver = "fixed-point"},
                                 Request{.alpha = "3/10", .beta = "h/7", .gamma = "-h/9"}}) {
    EXPECT_EQ(run_program(program(header(escape, request), "{1, 1}", "0.1", Expected::either)), "");
  }
}

TEST(Failure, OfTheClosedFormRootLeavesTheStateAsItWas) {
  // The quadratic of alpha = 0 has no real root for large h q (p^2 + 1).
  const std::string product = "coordinate q\nmomentum p\nH = (q^2 + 1)*(p^2 + 1)/2\n";
  for (const char* alpha : {"0", "1"}) {
    EXPECT_EQ(run_program(
                  program(header(product, {.alpha = alpha}), "{1, -3}", "10.0", Expected::failure)),
              "")
        << alpha;
  }
}

TEST(Failure, AnAbsurdStepNeverGivesAStateThatIsNotFinite) {
  const std::string steps = "1e3, -1e3, 1e30, 1e160, 1e300, -1e300, 1e-320, 0.0";
  for (const Request& request :
       {Request{}, Request{.alpha = "0"}, Request{.solver = "fixed-point"}}) {
    EXPECT_EQ(
        run_program(program(header(pendulum_text, request), "{3, 0.5}", steps, Expected::either)),
        "");
  }
}

// The gradient at its end is not that at the state it left: 0 there, and all but 1e165 here.
TEST(Failure, AFailedStepFailsAgain) {
  const std::string hill = "coordinate q\nmomentum p\nH = p^2/2 - 1e165*exp(-q^2)\n";
  EXPECT_EQ(
      run_program(without_pragma(header(hill, {.scheme = "stormer-verlet"})) +
                  "#include <cstdio>\nint main() {\n"
                  "  model::Propagator run({}, 0.1, model::State{0.7, 0});\n"
                  "  for (int i = 0; i < 3; ++i) {\n"
                  "    if (run.step().converged) std::puts(\"converged\");\n"
                  "    if (run.state().q != 0.7 || run.state().p != 0) std::puts(\"moved\");\n"
                  "  }\n}\n"),
      "");
}

TEST(Failure, AnInitialStateThatIsNotFiniteFailsAtOnce) {
  EXPECT_EQ(
      run_program(without_pragma(header(pendulum_text, {})) +
                  "#include <cstdio>\n#include <initializer_list>\nint main() {\n  const double "
                  "inf = 1.0e308 * 10;\n"
                  "  for (model::State z : {model::State{inf, 0}, model::State{0, inf}, "
                  "model::State{0 * inf, 0}}) {\n"
                  "    if (model::step({}, 0.1, z).converged) std::puts(\"converged\");\n  }\n}\n"),
      "");
}

// Of four equations solved together by elimination, alone and as one of two lanes.
TEST(Failure, OfAMatrixThatIsNotFiniteSaysSoOfTheIncrement) {
  const std::string four =
      "coordinate a, b, c, d\nmomentum u, v, w, x\n"
      "H = (u^2 + v^2 + w^2 + x^2)/2 + b^2*c^2*d^2 + a^2*c^2 + sqrt(1 - a^2)*b\n";
  const std::string main =
      "#include <cmath>\n#include <cstdio>\nint main() {\n  model::State z = {};\n"
      "  z.a = z.a + 0.9;\n  z.b = z.b + 0.1;\n  z.c = z.c + 0.2;\n  z.d = z.d + 0.3;\n";
  EXPECT_EQ(run_program(without_pragma(header(four, {})) + main +
                        "  z.u = 2;\n  const auto report = model::step({}, 0.2, z);\n"
                        "  std::printf(\"%d %d\", report.converged, "
                        "std::isfinite(report.increment));\n}\n"),
            "0 0");
  EXPECT_EQ(run_program(without_pragma(header(four, {.batch = 2})) + main +
                        "  z.u.set(0, 2);\n  model::Propagator run({}, model::Real() + 0.2, z);\n"
                        "  const auto report = run.step();\n"
                        "  for (int l = 0; l < 2; ++l)\n"
                        "    std::printf(\"%d %d \", report.converged[l] != 0, "
                        "std::isfinite(double(report.increment[l])) != 0);\n}\n"),
            "0 0 1 1 ");
}

TEST(Failure, ASoundStepDoesNotFail) {
  for (const char* solver : {"newton", "fixed-point"}) {
    for (const char* scalar : {"double", "float", "quad"}) {
      EXPECT_EQ(
          run_program(program(header(pendulum_text, {.solver = solver, .scalar = scalar}),
                              "{3, 0.5f}, {0, 0}, {1e-30f, 0}", "0.1, 0.3", Expected::success)),
          "")
          << solver << " in " << scalar;
    }
  }
}

}  // namespace
}  // namespace hamgen::emitted_test
