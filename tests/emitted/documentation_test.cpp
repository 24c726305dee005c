// The program in docs/emitted-code.md is one.
#include <gtest/gtest.h>

#include <cstdlib>

#include "generator/base/source_text.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

const std::string documented_root = HAMGEN_SOURCE_DIR;

// What stands between ```cpp and ``` in the file, the first time or the next.
std::string program_of(const std::string& file, int number = 0) {
  const std::string text = read(documented_root + file);
  const std::string begin = "```cpp\n";
  auto from = text.find(begin) + begin.size();
  for (; number > 0; --number) from = text.find(begin, from) + begin.size();
  return text.substr(from, text.find("```\n", from) - from);
}

TEST(Documentation, TheProgramOfEmittedCodeRunsAndKeepsTheEnergy) {
  std::string program = program_of("/docs/emitted-code.md");
  const std::string include = "#include \"fput.hpp\"\n";
  const auto at = program.find(include);
  ASSERT_NE(at, std::string::npos);
  const std::string header =
      generate(read_source(documented_root + "/hamiltonians/fput.ham"), {}).at(0).text;
  program.replace(at, include.size(), without_pragma(header));
  const std::string output = run_program(program);
  ASSERT_TRUE(output.ends_with("\n")) << output;
  // The midpoint rule keeps it to h^2 times what the motion changes of its parts.
  EXPECT_LT(std::abs(std::strtod(output.c_str(), nullptr)), 1e-2) << output;
}

TEST(Documentation, TheProgramOfTwoMethodsRuns) {
  std::string program = program_of("/docs/emitted-code.md", 1);
  const SourceText model = read_source(documented_root + "/hamiltonians/fput.ham");
  for (const auto& [folder, scheme] : {std::pair("midpoint", ""), {"verlet", "stormer-verlet"}}) {
    const std::string include = std::string("#include \"") + folder + "/fput.hpp\"";
    const auto at = program.find(include);
    ASSERT_NE(at, std::string::npos);
    const auto end = program.find('\n', at) + 1;
    program.replace(at, end - at, without_pragma(generate(model, {.scheme = scheme}).at(0).text));
  }
  EXPECT_EQ(run_program(program), "");
}

TEST(Documentation, TheProgramWithEventsRuns) {
  std::string program = program_of("/docs/emitted-code.md", 2);
  const std::string text = read(documented_root + "/docs/emitted-code.md");
  const auto from = text.find("```ham\n") + 7;
  const SourceText model =
      make_source("ball.ham", text.substr(from, text.find("```\n", from) - from));
  const auto at = program.find("#include \"ball.hpp\"");
  ASSERT_NE(at, std::string::npos);
  const auto end = program.find('\n', at) + 1;
  program.replace(at, end - at, without_pragma(generate(model, {.events = true}).at(0).text));
  // p^2/(2 g), which a step of a quadratic H conserves.
  EXPECT_EQ(run_program(program), "5.096840 m\n2.04 s\n");
}

TEST(Documentation, TheProgramInCCompiles) {
  const std::string text = read(documented_root + "/docs/emitted-code.md");
  const auto from = text.find("```c\n") + 5;
  std::string program = text.substr(from, text.find("```\n", from) - from);
  const std::string include = "#include \"pendulum.h\"\n";
  const auto at = program.find(include);
  ASSERT_NE(at, std::string::npos);
  const SourceText model = read_source(documented_root + "/hamiltonians/pendulum.ham");
  program.replace(at, include.size(),
                  without_pragma(generate(model, {.format = "c-header"}).at(0).text));
  EXPECT_EQ(messages("gcc", program, {"-x", "c", "-std=c11", "-Wall", "-Wextra", "-Wpedantic"}),
            "");
}

TEST(Documentation, TheKernelInOpenClCompiles) {
  const std::string text = read(documented_root + "/docs/emitted-code.md");
  const std::string include = "#include \"pendulum.cl\"\n";
  const auto from = text.find(include);
  ASSERT_NE(from, std::string::npos);
  const SourceText model = read_source(documented_root + "/hamiltonians/pendulum.ham");
  const std::string header = generate(model, {.format = "opencl-header"}).at(0).text;
  const auto kernel = from + include.size();
  EXPECT_EQ(
      messages("clang",
               without_pragma(header) + text.substr(kernel, text.find("```", kernel) - kernel),
               {"-x", "cl", "-cl-std=CL2.0", "-Xclang", "-finclude-default-header", "-Wall",
                "-Wno-unused-function", "-Wno-ignored-pragmas"}),
      "");
}

// Every name in the table of parts is one of the header's.
TEST(Documentation, ThePartsOfAHeaderAreThere) {
  const std::string header = generate(read_source(documented_root + "/hamiltonians/fput.ham"),
                                      {.scheme = "gauss-4", .tangent = true})
                                 .at(0)
                                 .text;
  for (const char* part :
       {"Real",     "Parameters", "State",  "StepReport", "energy(",  "Coefficients", "prepare(",
        "Start",    "solve(",     "step(",  "Propagator", "advance(", "state()",      "carry()",
        "tangent(", "gradient(",  "reset(", "time()",     "h()",      "parameters()"}) {
    EXPECT_NE(header.find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace hamgen::emitted_test
