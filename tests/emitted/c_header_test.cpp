// Headers in C11: they take the steps of those in C++, to the last bit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "generator/algebra/scalar.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/source_text.hpp"
#include "runtime/temporary_directory.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

struct Method {
  std::string model;
  Request request;
};

std::vector<Method> methods() {
  return {{"pendulum", {}},
          {"pendulum", {.scalar = "float"}},
          {"pendulum", {.scalar = "long-double"}},
          {"pendulum", {.alpha = "3/10", .beta = "h/7", .gamma = "-h/9"}},
          {"pendulum", {.scheme = "saba-2"}},
          {"kepler", {}},
          {"kepler", {.scheme = "stormer-verlet"}},
          {"kepler", {.scheme = "rk4"}},
          {"henon_heiles", {.scheme = "yoshida-4"}},
          {"henon_heiles", {.solver = "sweeps:3"}},
          {"harmonic", {}},
          {"driven_oscillator", {}}};
}

// The first and the last component of the state, the others are 1/16: a circle, or bound.
const char* ends(const Method& method) { return method.model == "kepler" ? "1" : "0.25"; }

// Both programs print this of a thousand steps from a state of simple numbers: every byte of the
// numbers, of which long double has ten.
constexpr const char* kPrint = R"(
static void print(const void* numbers, int count, int size) {{
  const unsigned char* bytes = (const unsigned char*)numbers;
  for (int i = 0; i < count * size; ++i) {{
    if (i % size < 10) printf("%02x", bytes[i]);
  }}
}}
)";

std::string c_program() {
  std::string text = "#include <stdio.h>\n";
  std::string calls;
  int number = 0;
  for (const Method& method : methods()) {
    Request request = method.request;
    request.format = "c-header";
    request.name_space = fmt::format("m{}", number);
    text += without_pragma(emit(shipped(method.model), request).at(0).text);
    calls += fmt::format(R"(  {{
    m{0}_State z;
    {1}* x = ({1}*)&z;
    const int count = (int)(sizeof z / sizeof *x);
    for (int i = 0; i < count; ++i) x[i] = i == 0 || i + 1 == count ? ({1}){3} : ({1})0.0625;
    const m{0}_Parameters par = m{0}_default_parameters();
    m{0}_Propagator run = m{0}_Propagator_make(&par, ({1})0.0625, &z);
    const hamgen_StepReport{2} report = m{0}_Propagator_advance(&run, 1000);
    printf("{0} %d %lld ", report.converged, report.iterations);
    print(&run.z, count, (int)sizeof *x);
    print(&run.carry, count, (int)sizeof *x);
    const {1} values[2] = {{m{0}_energy(&par, &run.z), m{0}_Propagator_time(&run)}};
    print(values, 2, (int)sizeof *x);
    m{0}_Propagator_reset(&run, &z);
    if (!m{0}_Propagator_step(&run).converged || !m{0}_step(&par, ({1})0.0625, &z).converged) return 1;
    print(&z, count, (int)sizeof *x);
    print(&run.z, count, (int)sizeof *x);
    puts("");
  }}
)",
                         number++, request.scalar->type->cpp,
                         request.scalar == "float"         ? "f"
                         : request.scalar == "long-double" ? "l"
                                                           : "",
                         ends(method));
  }
  return text + fmt::format(fmt::runtime(kPrint)) + "int main(void) {\n" + calls + "}\n";
}

std::string cpp_program() {
  std::string text = "#include <cstdio>\n";
  std::string calls;
  int number = 0;
  for (const Method& method : methods()) {
    Request request = method.request;
    request.name_space = fmt::format("m{}", number);
    text += without_pragma(emit(shipped(method.model), request).at(0).text);
    calls += fmt::format(
        "  if (!run<m{0}::Propagator, m{0}::State, m{0}::Real>({0}, {1}, [](const auto& "
        "par, const auto& z) {{ return m{0}::energy(par, z); }}, "
        "[](const auto& par, auto h, auto& z) {{ return m{0}::step(par, h, "
        "z).converged; }}, m{0}::Parameters())) return 1;\n",
        number++, ends(method));
  }
  return text + fmt::format(fmt::runtime(kPrint)) + R"(
template <class Propagator, class State, class Real, class Energy, class Step, class Parameters>
bool run(int number, double ends, Energy energy, Step step, const Parameters& par) {
  State z;
  Real* x = reinterpret_cast<Real*>(&z);
  const int count = sizeof z / sizeof *x;
  for (int i = 0; i < count; ++i) x[i] = i == 0 || i + 1 == count ? Real(ends) : Real(0.0625);
  Propagator run(par, Real(0.0625), z);
  const auto report = run.advance(1000);
  printf("%d %d %lld ", number, report.converged, report.iterations);
  print(&run.state(), count, sizeof *x);
  print(&run.carry(), count, sizeof *x);
  const Real values[2] = {energy(par, run.state()), run.time()};
  print(values, 2, sizeof *x);
  run.reset(z);
  if (!run.step().converged || !step(par, Real(0.0625), z)) return false;
  print(&z, count, sizeof *x);
  print(&run.state(), count, sizeof *x);
  puts("");
  return true;
}
int main() {
)" + calls +
         "}\n";
}

TEST(CHeader, TakesTheStepsOfTheHeaderInCppToTheLastBit) {
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  const auto path = [&](const char* name) { return (directory.path() / name).string(); };
  std::ofstream(path("c.c")) << c_program();
  std::ofstream(path("cpp.cpp")) << cpp_program();
  ASSERT_EQ(output_of({"gcc", "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion",
                       "-Wsign-conversion", "-Wshadow", "-Wdouble-promotion", "-Werror", "-O1",
                       path("c.c"), "-o", path("c"), "-lm"}),
            "");
  ASSERT_EQ(output_of({"g++", "-std=c++17", "-O1", path("cpp.cpp"), "-o", path("cpp")}), "");
  const std::string expected = output_of({path("cpp")});
  EXPECT_EQ(output_of({path("c")}), expected);
  EXPECT_EQ(static_cast<std::size_t>(count(expected, "\n")), methods().size());
  EXPECT_EQ(static_cast<std::size_t>(count(expected, " 1 ")), methods().size()) << expected;
}

TEST(CHeader, MeetsOthersOfItsSystem) {
  const auto header = [](Request request) {
    request.format = "c-header";
    return without_pragma(emit(shipped("pendulum"), request).at(0).text);
  };
  const std::string three = header({}) + header({.scheme = "stormer-verlet"}) + header({});
  EXPECT_EQ(messages("gcc", three + header({.scalar = "float"}), {"-x", "c", "-std=c11", "-Wall"}),
            "");
  EXPECT_NE(messages("gcc", three + header({.name_space = "pendulum", .fold = {"eps"}}),
                     {"-x", "c", "-std=c11", "-Wall"})
                .find("another text of this name"),
            std::string::npos);
}

TEST(CHeader, RefusesWhatItHasNoBlocksForAndSaysWhatItHas) {
  for (Request request :
       {Request{.scheme = "gauss-4"}, Request{.solver = "fixed-point"}, Request{.tangent = true},
        Request{.scalar = "quad"}, Request{.alpha = "alpha"}, Request{.support = "shared"}}) {
    request.format = "c-header";
    try {
      static_cast<void>(emit(shipped("pendulum"), request));
      ADD_FAILURE() << request.scheme.text() << request.solver.text() << request.scalar.text();
    } catch (const UsageError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("help: "), std::string::npos) << what;
      EXPECT_EQ(what.find("--scheme"), std::string::npos) << what;  // which this H may not suit
    }
  }
  EXPECT_THROW(static_cast<void>(emit(shipped("fput"), {.format = "c-header"})), UsageError);
}

}  // namespace
}  // namespace hamgen::emitted_test
