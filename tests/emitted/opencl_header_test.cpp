// Headers in OpenCL C, compiled for this machine: they take the steps of those in C, to the last
// bit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "generator/base/c_family.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/source_text.hpp"
#include "runtime/temporary_directory.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

struct StepInOpenCl {
  std::string model;
  Request request;
};

std::vector<StepInOpenCl> steps_in_opencl() {
  return {{"pendulum", {}},
          {"pendulum", {.scalar = "float"}},
          {"pendulum", {.alpha = "3/10", .beta = "h/7", .gamma = "-h/9"}},
          {"kepler", {}},
          {"kepler", {.scheme = "stormer-verlet", .scalar = "float"}},
          {"henon_heiles", {.scheme = "yoshida-4"}},
          {"driven_oscillator", {}}};
}

// Functions `space`0, `space`1, ... that take 1000 steps by these headers and tell all there is.
std::string functions_in(const std::string& format, const std::string& space) {
  std::string text;
  int number = 0;
  for (const StepInOpenCl& method : steps_in_opencl()) {
    Request request = method.request;
    request.format = format;
    request.name_space = fmt::format("m{}", number);
    const bool single = request.scalar == "float";
    text += without_pragma(emit(shipped(method.model), request).at(0).text);
    text += fmt::format(R"(
void {3}{0}(__global {1}* out);
void {3}{0}(__global {1}* out) {{
  const m{0}_Parameters par = m{0}_default_parameters();
  m{0}_State z;
  {1}* x = ({1}*)&z;
  const int count = (int)(sizeof z / sizeof *x);
  for (int i = 0; i < count; ++i) x[i] = i == 0 || i + 1 == count ? ({1}){4} : ({1})0.0625;
  m{0}_Propagator run = m{0}_Propagator_make(&par, ({1})0.0625, &z);
  const hamgen_StepReport{2} report = m{0}_Propagator_advance(&run, 1000);
  const {1}* state = (const {1}*)&run.z;
  const {1}* carry = (const {1}*)&run.carry;
  for (int i = 0; i < count; ++i) out[i] = state[i];
  for (int i = 0; i < count; ++i) out[count + i] = carry[i];
  out[2 * count] = m{0}_energy(&par, &run.z);
  out[2 * count + 1] = m{0}_Propagator_time(&run);
  out[2 * count + 2] = ({1})report.iterations;
  out[2 * count + 3] = report.converged ? ({1})1 : ({1})0;
}}
)",
                        number++, single ? "float" : "double", single ? "f" : "", space,
                        method.model == "kepler" ? "1" : "0.25");  // a circle, or bound
  }
  return text;
}

// A program that prints what both have found, byte by byte.
std::string program_that_compares() {
  std::string text = "#include <stdio.h>\n#include <string.h>\n";
  std::string calls;
  int number = 0;
  for (const StepInOpenCl& method : steps_in_opencl()) {
    const char* real = method.request.scalar == "float" ? "float" : "double";
    text += fmt::format("void c{0}({1}*);\nvoid cl{0}({1}*);\n", number, real);
    calls += fmt::format(
        "  {{ {1} a[16] = {{0}}, b[16] = {{0}}; c{0}(a); cl{0}(b); int last = 15;\n"
        "    while (last > 0 && a[last] == 0) --last;\n"
        "    printf(\"%s %g\\n\", memcmp(a, b, sizeof a) == 0 ? \"same\" : \"different\","
        " (double)a[last]); }}\n",
        number++, real);
  }
  return text + "int main(void) {\n" + calls + "  return 0;\n}\n";
}

// The functions of OpenCL C by the names that they have there: those of the C library.
std::string library_of_opencl() {
  std::string text;
  for (const char* name : {"sin", "cos", "sqrt", "fabs"}) {
    text += fmt::format(
        "double {0}(double);\nfloat {0}f(float);\n"
        "double double_{0}(double x) __asm__(\"_Z{1}{0}d\");\n"
        "double double_{0}(double x) {{ return {0}(x); }}\n"
        "float float_{0}(float x) __asm__(\"_Z{1}{0}f\");\n"
        "float float_{0}(float x) {{ return {0}f(x); }}\n",
        name, std::string_view(name).size());
  }
  return text;
}

TEST(OpenClHeader, TakesTheStepsOfTheHeaderInCToTheLastBit) {
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  const auto path = [&](const char* name) { return (directory.path() / name).string(); };
  std::ofstream(path("c.c")) << "#define __global\n" << functions_in("c-header", "c");
  std::ofstream(path("cl.cl")) << functions_in("opencl-header", "cl");
  std::ofstream(path("library.c")) << library_of_opencl();
  std::ofstream(path("main.c")) << program_that_compares();
  ASSERT_EQ(output_of({"clang", "-x", "cl", "-cl-std=CL2.0", "-Wall", "-Wextra", "-Werror", "-O1",
                       "-Wno-ignored-pragmas", "-Wno-unused-function", "-Xclang",
                       "-finclude-default-header", "-c", path("cl.cl"), "-o", path("cl.o")}),
            "");
  ASSERT_EQ(output_of({"gcc", "-std=c11", "-O1", "-fno-builtin", path("main.c"), path("c.c"),
                       path("library.c"), path("cl.o"), "-o", path("both"), "-lm"}),
            "");
  const std::string found = output_of({path("both")});
  EXPECT_EQ(static_cast<std::size_t>(count(found, "same 1\n")), steps_in_opencl().size()) << found;
}

TEST(OpenClHeader, HasItsOwnWordsInCodeOnly) {
  const CFamily& opencl = c_families()[1];
  EXPECT_EQ(in_words_of(opencl,
                        "static const double hamgen_pi = 3;  // a static const long long\n"
                        "long long steps, longs, a_long;\n"
                        "along long long_long;\n"
                        "static constant; half half_h;  // half\n"),
            "__constant double hamgen_pi = 3;  // a static const long long\n"
            "long steps, longs, a_long;\n"
            "along long long_long;\n"
            "static constant_; half_ half_h;  // half\n");
  EXPECT_THROW((void)in_words_of(opencl, "double half_;\n"), UsageError);
  EXPECT_NO_THROW((void)in_words_of(c_families()[0], "double half_;\n"));
  EXPECT_EQ(in_words_of(opencl, "double x;  // half_\n"), "double x;  // half_\n");
}

// A model may have them all the same.
TEST(OpenClHeader, NamesThatAreItsWordsGetAnUnderscore) {
  const std::string model =
      "system kernel\ncoordinate half, global\nmomentum local, generic\n"
      "parameter constant = 2\n"
      "H = (local^2 + generic^2)/2 - constant*cos(half) + half*global^2\n";
  const std::string text =
      emit(make_source("names.ham", model), Request{.format = "opencl-header"}).at(0).text;
  EXPECT_NE(text.find("double half_"), std::string::npos);
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  const std::string path = (directory.path() / "names.cl").string();
  std::ofstream(path) << without_pragma(text);
  EXPECT_EQ(output_of({"clang", "-x", "cl", "-cl-std=CL2.0", "-Wall", "-Wextra", "-Werror",
                       "-Wno-ignored-pragmas", "-Wno-unused-function", "-Xclang",
                       "-finclude-default-header", "-fsyntax-only", path}),
            "");
}

TEST(OpenClHeader, RefusesWhatTheLanguageHasNot) {
  for (Request request : {Request{.scalar = "long-double"}, Request{.scalar = "quad"},
                          Request{.scheme = "gauss-4"}, Request{.batch = 4}}) {
    request.format = "opencl-header";
    try {
      static_cast<void>(emit(shipped("pendulum"), request));
      ADD_FAILURE() << request.scheme.text() << request.scalar.text();
    } catch (const UsageError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find("--format opencl-header: "), 0U) << what;
      EXPECT_NE(what.find("help: "), std::string::npos) << what;
    }
  }
}

}  // namespace
}  // namespace hamgen::emitted_test
